#include "firmware/supervision/motion_check.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/supervision/end_stop.hpp"

namespace sandhopper {
namespace {

constexpr std::size_t kX = 0, kY = 1, kZ = 2;
constexpr int kDisagree_cycles = 10;   // an impact reaches encoders and IMUs at different cycles
constexpr double kImpact_mps2 = 40.0;  // change from one cycle to the next that counts as an impact
constexpr double kImpactRate_mps = 0.08;
constexpr double kSpins = 3.0;
constexpr double kTiltTime_s = 0.5;       // time constant of the complementary filter: gyro for faster
                                          // motion, gravity for slower
constexpr double kTiltAccel_share = 0.3;  // gravity is used if its magnitude is within this share
constexpr double kBodySpeed_mps = 3.0;    // largest speed of the ToF's height
constexpr int kTofOutliers = 5;
constexpr double kLoadCellTime_s = 0.015;
constexpr double kLoadCellShare = 0.5;  // tolerance as a share of the force, in addition to the limit
constexpr int kLoadCellWrong = 5;
constexpr int kEnergy_cycles = 5;
constexpr int kHeightsRefused = 20;  // a sound filter rejects at most three in a row

double followed(double value, double target, double dt_s, double time_s) noexcept {
  return value + std::clamp(dt_s / time_s, 0.0, 1.0) * (target - value);
}

}  // namespace

void MotionCheck::see(const SensorFrame& frame, const Estimate& estimate, const Context& context,
                      Findings& findings) noexcept {
  see_imus(frame, context, findings);
  if (frame.imu_body.fresh) see_tilt(frame.imu_body, context.dt_s, findings);
  if (frame.tof.fresh) see_tof(frame.tof, findings);
  if (!context.estimating) {
    in_flight_ = false;
    load_cell_error_N_ = 0.0;
    heights_refused_ = 0;
    return;
  }
  if (!strikes_end_stop(frame.imu_body, config_)) see_load_cell(estimate, context, findings);
  see_estimate(estimate, context, findings);
  see_height(estimate, findings);
  see_energy(estimate, context, findings);
}

double MotionCheck::leg_rate_mps(const SensorFrame& frame) const noexcept {
  const bool two = config_.robot.motor_count == 2;
  const double angle =
      two ? 0.5 * (frame.motor[0].position_rad + frame.motor[1].position_rad) : frame.motor[0].position_rad;
  const double rate = two ? 0.5 * (frame.motor[0].velocity_radps + frame.motor[1].velocity_radps)
                          : frame.motor[0].velocity_radps;
  return leg_.kinematics(angle).dlength_m_per_rad * rate;
}

// Checks over the window: integral of (a_body - a_foot) = change of the leg's rate.
void MotionCheck::see_imus(const SensorFrame& frame, const Context& context, Findings& findings) noexcept {
  const auto& s = config_.supervision;
  const std::array<const ImuSample*, 2> imu{&frame.imu_body, &frame.imu_foot};
  for (std::size_t i = 0; i < imu.size(); ++i) {
    double spin = 0.0;
    for (const double rate : imu[i]->gyro_radps) spin = std::max(spin, std::abs(rate));
    if (imu[i]->fresh)
      findings.add_if(spin_[i].see(spin > s.imu_gyro_radps) >= kSpins, Fault::imu_implausible,
                      static_cast<double>(i), spin);
  }
  const bool clipped = std::abs(imu[0]->accel_mps2[kZ]) > 0.9 * s.imu_range_mps2 ||
                       std::abs(imu[1]->accel_mps2[kZ]) > 0.9 * s.imu_range_mps2;
  // An impact shorter than a cycle falls between two samples, so the integral would miss it.
  bool impact = false;
  for (std::size_t i = 0; i < imu.size(); ++i) {
    impact = impact || std::abs(imu[i]->accel_mps2[kZ] - last_accel_mps2_[i]) > kImpact_mps2;
    last_accel_mps2_[i] = imu[i]->accel_mps2[kZ];
  }
  const double rate_mps = leg_rate_mps(frame);
  if (cycles_ > 0) {
    const double last_mps = window_[(cycles_ - 1) % kWindow_cycles].leg_rate_mps;
    impact = impact || std::abs(rate_mps - last_mps) > kImpactRate_mps;
  }
  const bool usable = imu[0]->fresh && imu[1]->fresh && frame.motor[0].fresh && !clipped && !impact;
  blind_ = usable ? std::max(0, blind_ - 1) : static_cast<int>(kWindow_cycles) + kDisagree_cycles;
  const double difference = imu[0]->accel_mps2[kZ] - imu[1]->accel_mps2[kZ];
  if (std::isfinite(difference)) integral_mps_ += difference * context.dt_s;
  auto& slot = window_[cycles_ % kWindow_cycles];
  const Instant now{integral_mps_, rate_mps};
  const double error = (now.integral_mps - slot.integral_mps) - (now.leg_rate_mps - slot.leg_rate_mps);
  slot = now;
  if (++cycles_ <= kWindow_cycles || blind_ > 0) return;
  disagree_ = std::abs(error) <= s.imu_disagreement_mps ? 0 : disagree_ + 1;
  findings.add_if(disagree_ >= kDisagree_cycles, Fault::imu_implausible, 2.0, error);
}

void MotionCheck::see_tilt(const ImuSample& imu, double dt_s, Findings& findings) noexcept {
  const auto& a = imu.accel_mps2;
  const double g = std::hypot(a[kX], a[kY], a[kZ]);
  const bool gravity = a[kZ] > 0.0 && std::abs(g / kGravity_mps2 - 1.0) < kTiltAccel_share;
  const std::array<double, 2> leans{std::atan2(a[kY], a[kZ]), std::atan2(-a[kX], a[kZ])};
  for (std::size_t i = 0; i < 2; ++i) {
    const double spun = tilt_rad_[i] + imu.gyro_radps[i] * dt_s;
    tilt_rad_[i] = !gravity ? spun : tilt_known_ ? followed(spun, leans[i], dt_s, kTiltTime_s) : leans[i];
    if (!std::isfinite(tilt_rad_[i])) tilt_rad_[i] = 0.0;
  }
  tilt_known_ = tilt_known_ || gravity;
  const double tilt = std::hypot(tilt_rad_[0], tilt_rad_[1]);
  findings.add_if(tilt > config_.supervision.tilt_rad, Fault::tilt_limit, tilt, config_.supervision.tilt_rad);
}

// One outlier is ignored; several in a row that a body could not have reached are a fault.
void MotionCheck::see_tof(const TofSample& tof, Findings& findings) noexcept {
  if (!std::isfinite(tof.height_m)) return;
  const double since_s = static_cast<double>(tof.time_ns - tof_level_ns_) * 1e-9;
  const double allowed = config_.supervision.tof_jump_m + kBodySpeed_mps * std::max(0.0, since_s);
  const double jump = tof.height_m - tof_level_m_;
  if (tof_level_ns_ != 0 && std::abs(jump) > allowed) {
    findings.add_if(++tof_outliers_ >= kTofOutliers, Fault::tof_implausible, jump, allowed);
    return;
  }
  tof_outliers_ = 0;
  tof_level_m_ = tof.height_m;
  tof_level_ns_ = tof.time_ns;
}

void MotionCheck::see_load_cell(const Estimate& e, const Context& context, Findings& findings) noexcept {
  const double error = e.load_cell_force_N - e.contact_force_N;
  if (!std::isfinite(error)) return;
  load_cell_error_N_ = followed(load_cell_error_N_, error, context.dt_s, kLoadCellTime_s);
  const double allowed = config_.supervision.load_cell_error_N + kLoadCellShare * std::abs(e.contact_force_N);
  load_cell_wrong_ = std::abs(load_cell_error_N_) > allowed ? load_cell_wrong_ + 1 : 0;
  findings.add_if(load_cell_wrong_ >= kLoadCellWrong, Fault::load_cell_implausible, load_cell_error_N_,
                  allowed);
}

void MotionCheck::see_estimate(const Estimate& e, const Context&, Findings& findings) noexcept {
  const auto& s = config_.supervision;
  const bool finite =
      std::isfinite(e.contact_force_N + e.foot_z_m + e.body_z_m + e.leg_length_m + e.leg_rate_mps);
  findings.add_if(!finite, Fault::estimate_not_finite, e.contact_force_N, e.foot_z_m);
  if (!finite) return;
  findings.add_if(e.leg_length_m < s.leg_length_min_m || e.leg_length_m > s.leg_length_max_m,
                  Fault::leg_length_limit, e.leg_length_m,
                  e.leg_length_m < s.leg_length_min_m ? s.leg_length_min_m : s.leg_length_max_m);
  findings.add_if(std::abs(e.body_velocity_mps) > s.body_speed_mps, Fault::body_speed_limit,
                  e.body_velocity_mps, s.body_speed_mps);
  findings.add_if(e.foot_z_m > s.foot_height_m, Fault::body_height_limit, e.foot_z_m, s.foot_height_m);
}

// The filter rejects readings beyond its gate. So an estimate with a larger error is no longer corrected and
// gets worse.
void MotionCheck::see_height(const Estimate& e, Findings& findings) noexcept {
  const double squared = e.normalised_innovation_squared[0];
  if (!std::isfinite(squared)) return;  // no reading in this cycle
  const double gate = config_.estimator.kalman.tof_gate_sigma;
  heights_refused_ = squared > gate * gate ? heights_refused_ + 1 : 0;
  findings.add_if(heights_refused_ >= kHeightsRefused, Fault::estimate_diverged, e.innovation[0],
                  heights_refused_);
}

// Body and foot as two masses; the links' share is small compared with the limit.
void MotionCheck::see_energy(const Estimate& e, const Context& context, Findings& findings) noexcept {
  const auto& r = config_.robot;
  const auto energy = [](double mass, double z, double v) {
    return mass * (kGravity_mps2 * z + 0.5 * v * v);
  };
  const double now_J = energy(r.body_mass_kg, e.body_z_m, e.body_velocity_mps) +
                       energy(r.foot_mass_kg, e.foot_z_m, e.foot_velocity_mps);
  const bool flight = context.state == State::flight;
  if (!flight || !in_flight_) {
    in_flight_ = flight;
    flight_energy_J_ = now_J;
    too_energetic_ = 0;
    return;
  }
  const double gain_J = now_J - flight_energy_J_;
  too_energetic_ = gain_J > config_.supervision.energy_gain_J ? too_energetic_ + 1 : 0;
  findings.add_if(too_energetic_ >= kEnergy_cycles, Fault::energy_implausible, gain_J,
                  config_.supervision.energy_gain_J);
}

}  // namespace sandhopper
