#pragma once
#include <array>
#include <cstdint>

#include "estimation/kalman_filter.hpp"
#include "estimation/leg.hpp"
#include "estimation/momentum_observer.hpp"
#include "firmware/controller_config.hpp"
#include "firmware/records.hpp"
#include "firmware/sensor_frame.hpp"

namespace sandhopper {

// Values measured while the robot hangs still before a hop.
struct StaticCalibration {
  double body_bias_mps2 = 0.0;
  double foot_bias_mps2 = 0.0;
  double load_cell_tare_N = 0.0;
  double body_height_m = 0.0;
};

// Mean of the motors' link angles, rates and total torque; with a single motor the left one drives both
// sides.
struct LegMeasurement {
  double angle_rad;
  double rate_radps;
  double torque_Nm;
};
LegMeasurement leg_measurement(const SensorFrame& frame, const CycleConfig& config) noexcept;

// Estimates body, foot and ground force frame by frame. The Kalman state belongs to the cycle's time. Forces
// belong to the instant of the newest motor reply, and the Kalman state is carried back to that instant, so
// that force, depth and speed match.
class RobotEstimator {
 public:
  RobotEstimator(const CycleConfig& config, const Leg& leg) noexcept;

  // Starts at rest in the hanging pose.
  void start(const StaticCalibration& calibration, const SensorFrame& frame) noexcept;
  // True while the body hangs: then the ground force is known to be zero.
  void hold_force_at_zero(bool hold) noexcept { hold_force_ = hold; }

  // Processes one frame and fills `estimate`.
  void update(const SensorFrame& frame, Estimate& estimate) noexcept;

 private:
  struct ForceTerms {
    double momentum_kg_mps;
    double psi_without_torque_N;
    double torque_gain_per_m;
    double coriolis_N;
  };
  ForceTerms force_terms(const LegDynamics& d, const BodyFootState& state) const noexcept;
  void update_leg(const SensorFrame& frame, Estimate& estimate) noexcept;
  void update_height(const SensorFrame& frame, Estimate& estimate) noexcept;
  void update_force(const SensorFrame& frame, const LegMeasurement& leg, const LegDynamics& d,
                    Estimate& estimate) noexcept;
  void write_state(Estimate& estimate) const noexcept;

  const CycleConfig& config_;
  const Leg& leg_;
  KalmanFilter filter_;
  MomentumObserver observer_;
  StaticCalibration calibration_{};
  ForceTerms last_terms_{};
  double last_torque_Nm_ = 0.0;
  double weighting_accel_mps2_ = 0.0;  // signed, low-passed
  std::int64_t last_time_ns_ = 0;
  std::int64_t last_force_time_ns_ = 0;
  bool hold_force_ = true;
};

}  // namespace sandhopper
