#include "firmware/robot_estimator.hpp"

#include <cmath>
#include <numbers>

namespace sandhopper {
namespace {

double seconds_between(std::int64_t from_ns, std::int64_t to_ns) noexcept {
  return static_cast<double>(to_ns - from_ns) * 1e-9;
}

constexpr std::size_t kVertical = 2;

}  // namespace

LegMeasurement leg_measurement(const SensorFrame& frame, const CycleConfig& config) noexcept {
  const auto& left = frame.motor[0];
  const auto& right = frame.motor[1];
  const auto& kt = config.torque_constant_Nm_per_A;
  if (config.robot.motor_count == 1) return {left.position_rad, left.velocity_radps, kt[0] * left.current_A};
  return {.angle_rad = 0.5 * (left.position_rad + right.position_rad),
          .rate_radps = 0.5 * (left.velocity_radps + right.velocity_radps),
          .torque_Nm = kt[0] * left.current_A + kt[1] * right.current_A};
}

RobotEstimator::RobotEstimator(const CycleConfig& config, const Leg& leg) noexcept
    : config_(config),
      leg_(leg),
      filter_(config.estimator.kalman),
      observer_(config.estimator.observer_gain_per_s) {}

void RobotEstimator::start(const StaticCalibration& calibration, const SensorFrame& frame) noexcept {
  calibration_ = calibration;
  const auto leg = leg_measurement(frame, config_);
  const double distance = leg_.kinematics(leg.angle_rad).length_m + config_.robot.foot_height_m;
  const double body = calibration.body_height_m;
  filter_.reset({body, 0.0, body - distance, 0.0});
  observer_.reset(0.0);
  last_time_ns_ = frame.time_ns;
  last_force_time_ns_ = frame.motor[0].time_ns;
  last_torque_Nm_ = leg.torque_Nm;
  last_terms_ = force_terms(leg_.dynamics(leg.angle_rad), filter_.state());
  weighting_accel_mps2_ = 0.0;
  hold_force_ = true;
}

void RobotEstimator::update(const SensorFrame& frame, Estimate& estimate) noexcept {
  const double dt = seconds_between(last_time_ns_, frame.time_ns);
  last_time_ns_ = frame.time_ns;
  estimate.innovation.fill(kNotMeasured);
  estimate.normalised_innovation_squared.fill(kNotMeasured);
  estimate.body_accel_mps2 =
      frame.imu_body.accel_mps2[kVertical] - kGravity_mps2 - calibration_.body_bias_mps2;
  estimate.foot_accel_mps2 =
      frame.imu_foot.accel_mps2[kVertical] - kGravity_mps2 - calibration_.foot_bias_mps2;

  const double keep = std::exp(-2.0 * std::numbers::pi * config_.estimator.weighting_accel_cutoff_Hz * dt);
  weighting_accel_mps2_ = keep * weighting_accel_mps2_ + (1.0 - keep) * estimate.foot_accel_mps2;
  estimate.weighting_accel_mps2 = std::abs(weighting_accel_mps2_);

  const bool at_range = std::abs(frame.imu_foot.accel_mps2[kVertical]) >= config_.supervision.imu_range_mps2;
  filter_.predict({estimate.body_accel_mps2, estimate.foot_accel_mps2, at_range}, dt);
  update_height(frame, estimate);
  update_leg(frame, estimate);
  if (frame.load_cell.fresh)
    estimate.load_cell_force_N = frame.load_cell.force_N - calibration_.load_cell_tare_N;
  write_state(estimate);
}

void RobotEstimator::update_height(const SensorFrame& frame, Estimate& estimate) noexcept {
  if (!frame.tof.fresh || !std::isfinite(frame.tof.height_m)) return;
  const double age = seconds_between(frame.tof.time_ns, frame.time_ns);
  const auto innovation = filter_.update_body_height(frame.tof.height_m, age);
  estimate.innovation[0] = innovation.value;
  estimate.normalised_innovation_squared[0] = innovation.normalised_squared;
}

void RobotEstimator::update_leg(const SensorFrame& frame, Estimate& estimate) noexcept {
  const bool both = frame.motor[0].fresh && (frame.motor[1].fresh || config_.robot.motor_count == 1);
  const auto leg = leg_measurement(frame, config_);
  const double age = seconds_between(frame.motor[0].time_ns, frame.time_ns);
  const auto d = leg_.dynamics(leg.angle_rad);
  if (both) {
    const auto length = filter_.update_leg_length(d.leg.length_m + config_.robot.foot_height_m, age);
    const auto rate = filter_.update_leg_rate(d.leg.dlength_m_per_rad * leg.rate_radps, age);
    estimate.innovation[1] = length.value;
    estimate.innovation[2] = rate.value;
    estimate.normalised_innovation_squared[1] = length.normalised_squared;
    estimate.normalised_innovation_squared[2] = rate.normalised_squared;
    update_force(frame, leg, d, estimate);
  }
  // Present state of the leg: the reply extrapolated over its age.
  const auto state = filter_.state();
  estimate.leg_angle_rad = leg.angle_rad + leg.rate_radps * age;
  estimate.leg_length_m = leg_.kinematics(estimate.leg_angle_rad).length_m;
  estimate.leg_rate_mps = state.body_velocity_mps - state.foot_velocity_mps;
  estimate.leg_torque_Nm = leg.torque_Nm;
}

RobotEstimator::ForceTerms RobotEstimator::force_terms(const LegDynamics& d,
                                                       const BodyFootState& state) const noexcept {
  const double v = state.foot_velocity_mps;
  const double rate = (state.body_velocity_mps - v) / d.leg.dlength_m_per_rad;
  const double coriolis = d.coriolis_N_s2_per_rad2 * rate * rate;
  return {.momentum_kg_mps = d.reduced_mass_kg * v,
          .psi_without_torque_N =
              -coriolis - d.reduced_mass_kg * kGravity_mps2 + d.dreduced_mass_kg_per_rad * rate * v,
          .torque_gain_per_m = d.torque_gain_per_m,
          .coriolis_N = coriolis};
}

void RobotEstimator::update_force(const SensorFrame& frame, const LegMeasurement& leg, const LegDynamics& d,
                                  Estimate& estimate) noexcept {
  const std::int64_t force_time_ns = frame.motor[0].time_ns;
  const double dt = seconds_between(last_force_time_ns_, force_time_ns);
  if (dt <= 0.0) return;
  const auto state = filter_.state_before(seconds_between(force_time_ns, frame.time_ns));
  const auto terms = force_terms(d, state);
  const double psi = 0.5 * (terms.psi_without_torque_N + last_terms_.psi_without_torque_N) -
                     0.5 * (terms.torque_gain_per_m + last_terms_.torque_gain_per_m) * 0.5 *
                         (leg.torque_Nm + last_torque_Nm_);
  if (hold_force_)
    observer_.reset(terms.momentum_kg_mps);
  else
    observer_.update(terms.momentum_kg_mps, psi, dt);
  last_terms_ = terms;
  last_torque_Nm_ = leg.torque_Nm;
  last_force_time_ns_ = force_time_ns;

  estimate.force_time_ns = force_time_ns;
  estimate.force_depth_m = -state.foot_z_m;
  estimate.force_velocity_mps = -state.foot_velocity_mps;
  estimate.contact_force_N = observer_.force_N();
  estimate.direct_force_N = d.reduced_mass_kg * (estimate.foot_accel_mps2 + kGravity_mps2) +
                            terms.torque_gain_per_m * leg.torque_Nm + terms.coriolis_N;
  estimate.quasi_static_force_N = leg.torque_Nm / d.leg.dlength_m_per_rad;
}

void RobotEstimator::write_state(Estimate& estimate) const noexcept {
  const auto state = filter_.state();
  estimate.body_z_m = state.body_z_m;
  estimate.body_velocity_mps = state.body_velocity_mps;
  estimate.foot_z_m = state.foot_z_m;
  estimate.foot_velocity_mps = state.foot_velocity_mps;
  for (int i = 0; i < 4; ++i)
    estimate.standard_deviation[static_cast<std::size_t>(i)] = std::sqrt(filter_.covariance()(i, i));
}

}  // namespace sandhopper
