#pragma once
#include <array>
#include <cstdint>

#include "terrain/joint_fit.hpp"
#include "terrain/profile_config.hpp"

// Stiffness k of the line on which a foot leaves its crater and returns. The foot moves by only a millimetre
// there, and the estimated depth drifts by as much. But the foot's accelerometer measures the change of speed
// when the force begins to fall and when it has fallen. While the foot unloads,
//   F = k z + c v + noise,   dz/dt = v,   dv/dt = a - b + noise
// with F the force and a the acceleration as measured, b the accelerometer's bias and c = 2 zeta sqrt(k M)
// the damping (bed.hpp). For given k and zeta the likelihood is that of a Kalman filter of z, v and b. zeta
// is integrated out, and k has a log-uniform prior. Between the points of a grid the log-likelihood is
// interpolated by a cubic in log k and a parabola in zeta. The likelihoods of the strides of one trial are
// multiplied. If the line is too steep for the sensors the result is a lower bound. Sources: the line and its
// damping as in bed.hpp; likelihood of a linear state-space model by prediction errors (Schweppe 1965).
namespace sandhopper {

// Samples of the last unloading of a stance, as means of two samples each.
struct UnloadingTrace {
  static constexpr std::size_t kPairs = 128;
  std::array<float, kPairs> force_N{};
  std::array<float, kPairs> accel_mps2{};  // down positive
  std::int32_t pairs = 0;
};

// Stores, in the cycle, the samples from the largest force down to a tenth of it. Impacts and samples with
// the foot moving down are excluded. Never allocates.
class UnloadingRecorder {
 public:
  explicit UnloadingRecorder(double min_speed_mps) : min_speed_mps_(min_speed_mps) {}
  void add(const JointSample& sample) noexcept;
  const UnloadingTrace& trace() const noexcept { return kept_; }
  void reset() noexcept;

 private:
  void restart(double peak_N) noexcept;
  void close() noexcept;

  double min_speed_mps_;
  UnloadingTrace current_{}, kept_{};
  double peak_N_ = 0.0;
  float half_force_N_ = 0.0F, half_accel_mps2_ = 0.0F;
  bool half_ = false;  // one sample of a pair has arrived
  bool open_ = false;
};

struct ReloadingLine {
  double value_N_per_m = 0.0;  // all three are zero if nothing is known
  double ci95_low_N_per_m = 0.0;
  double ci95_high_N_per_m = 0.0;  // infinite if only a lower bound is known
};

class ReloadingPosterior {
 public:
  static constexpr std::size_t kGrid = 24;

  // `force_scale_relative` is the relative error of the torque constant.
  ReloadingPosterior(const ProfileConfig& config, double force_noise_N, double force_scale_relative);
  void restart() noexcept;
  // `foot_kg` is M, the mass that oscillates on the line.
  void add(const UnloadingTrace& trace, double foot_kg) noexcept;
  ReloadingLine line() const noexcept;

 private:
  double stiffness_N_per_m(double place) const noexcept;
  double log_likelihood_at(double place) const noexcept;
  double log_likelihood(const UnloadingTrace& trace, double k, double c) const noexcept;

  ProfileConfig config_;
  double force_noise_N_, force_scale_relative_;
  std::array<double, kGrid> log_likelihood_{};
  bool known_ = false;
};

}  // namespace sandhopper
