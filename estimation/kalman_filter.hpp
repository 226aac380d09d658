#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "config/fields.hpp"

// Kalman filter of body and foot on the rail (paper, state estimation):
//   x = [z_b, v_b, z_f, v_f],  u = [a_b, a_f] (IMU specific force minus gravity and bias)
//   x+ = A x + B u,  A = blkdiag([1 T; 0 1]) twice,  B = blkdiag([T^2/2; T]) twice,  Q = B diag(sigma_a^2)
//   B^T y = [ToF height; leg length + foot height; leg rate],  H = [1 0 0 0; 1 0 -1 0; 0 1 0 -1]
// Each measurement is used once, when it is fresh, and at its own age: its row is that of the state `age`
// earlier. That state follows by inverting the prediction steps made since: z(t-a) = z - a v + displacement
// caused by the known input.
namespace sandhopper {

struct KalmanConfig {
  double body_accel_noise_mps2 = 0.5;
  double foot_accel_noise_mps2 = 1.0;
  double tof_noise_m = 0.006;
  double leg_length_noise_m = 1.0e-4;
  double leg_rate_noise_mps = 0.03;
  double tof_gate_sigma = 6.0;  // a ToF reading with a larger normalised innovation is rejected
  double initial_height_noise_m = 0.01;
  double initial_speed_noise_mps = 0.01;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("body_accel_noise_mps2", self.body_accel_noise_mps2, Range{1e-4, 100.0});
    visit("foot_accel_noise_mps2", self.foot_accel_noise_mps2, Range{1e-4, 100.0});
    visit("tof_noise_m", self.tof_noise_m, Range{1e-5, 1.0});
    visit("leg_length_noise_m", self.leg_length_noise_m, Range{1e-6, 0.1});
    visit("leg_rate_noise_mps", self.leg_rate_noise_mps, Range{1e-4, 10.0});
    visit("tof_gate_sigma", self.tof_gate_sigma, Range{1.0, 1000.0});
    visit("initial_height_noise_m", self.initial_height_noise_m, Range{1e-5, 1.0});
    visit("initial_speed_noise_mps", self.initial_speed_noise_mps, Range{1e-5, 10.0});
  }
};

struct BodyFootState {
  double body_z_m;
  double body_velocity_mps;
  double foot_z_m;
  double foot_velocity_mps;
};

struct BodyFootAccel {
  double body_mps2;
  double foot_mps2;
  bool foot_at_range = false;  // the sensor is at the end of its range: the true value may be larger
};

// Result of one measurement update: the innovation and its normalised square. Both are NaN if the measurement
// was not used.
struct Innovation {
  double value;
  double normalised_squared;
  bool gated = false;
};

class KalmanFilter {
 public:
  static constexpr std::size_t kHistory = 16;  // largest age of a measurement [prediction steps]

  explicit KalmanFilter(const KalmanConfig& config) noexcept;
  void reset(const BodyFootState& state) noexcept;

  // One step of dt_s with the acceleration of that step.
  void predict(const BodyFootAccel& accel, double dt_s) noexcept;

  // Each update takes a measurement of this age. Height of the body over the ground's zero [m].
  Innovation update_body_height(double height_m, double age_s) noexcept;
  // Hip-to-sole distance, i.e. leg length plus foot height.
  Innovation update_leg_length(double distance_m, double age_s) noexcept;
  Innovation update_leg_rate(double rate_mps, double age_s) noexcept;

  BodyFootState state() const noexcept;
  // Estimate of the state `age_s` ago from all data up to now. An age beyond the history is limited to it.
  BodyFootState state_before(double age_s) const noexcept;
  const Eigen::Matrix4d& covariance() const noexcept { return p_; }

 private:
  // Displacement dz and speed change dv that the inputs of the last age_s caused, per mass: z(t-a) = z - a v
  // + dz, v(t-a) = v - dv.
  struct Lookback {
    double age_s;
    std::array<double, 2> displacement_m;
    std::array<double, 2> speed_mps;
  };
  struct Step {
    BodyFootAccel accel;
    double dt_s;
  };
  Lookback look_back(double age_s) const noexcept;
  Innovation update(const Eigen::Vector4d& row, double residual, double noise, double gate_sigma) noexcept;

  KalmanConfig config_;
  Eigen::Vector4d x_ = Eigen::Vector4d::Zero();
  Eigen::Matrix4d p_ = Eigen::Matrix4d::Zero();
  std::array<Step, kHistory> history_{};
  std::size_t newest_ = 0;
  std::size_t filled_ = 0;
};

}  // namespace sandhopper
