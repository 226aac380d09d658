#include "tools/conceal/hopper/controller.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandhopper::conceal::hopper {
namespace {

constexpr double kTorqueStep_Nm = 36.0 / 16383.0 / 2.0;

}  // namespace

Controller::Controller(const World& world, const Setup& setup)
    : world_(world),
      kind_(setup.kind()),
      compression_N_per_m_(setup.number("compression_stiffness_N_per_m", 375.0) *
                           (1.0 + world.hidden.compression_gain)),
      extension_N_per_m_(setup.number("extension_stiffness_N_per_m", world.gains.extension_N_per_m) *
                         (1.0 + world.hidden.extension_gain)),
      sweep_centre_rad_(setup.number("sweep_centre_rad", 1.1)),
      sweep_rad_(setup.number("sweep_amplitude_rad", 0.4)),
      sweep_Hz_(setup.number("sweep_frequency_Hz", 2.0)) {
  if (kind_ == "hold" || kind_ == "press") phase_ = Phase::compression;
}

void Controller::switch_phase(const Seen& seen, double length_m, double rate_mps) {
  const auto& g = world_.gains;
  const double shorter_m = g.compression_length_m - length_m;
  if (seen.foot_over_surface_m > 0.0) left_ground_ = true;
  if (phase_ == Phase::flight) {
    const bool yields = shorter_m > g.touchdown_deflection_m || rate_mps < -g.touchdown_rate_mps;
    if (left_ground_ && seen.foot_over_surface_m <= 0.0 && yields) phase_ = Phase::compression;
  } else if (phase_ == Phase::compression) {
    if (rate_mps >= 0.0 && shorter_m > g.switch_deflection_m + world_.hidden.switch_late_m)
      phase_ = Phase::extension;
  } else if (length_m >= g.extension_length_m - g.liftoff_margin_m) {
    phase_ = Phase::flight;
    left_ground_ = false;  // The foot is still in its crater, below the surface.
  }
}

double Controller::hop_N(const Seen& seen, const Curve& leg, double rate_mps) {
  const auto& g = world_.gains;
  if (kind_ == "hop" || kind_.empty()) switch_phase(seen, leg.value, rate_mps);
  switch (phase_) {
    case Phase::flight:
      return g.flight_N_per_m * (g.compression_length_m - leg.value) - g.flight_damping_N_s_per_m * rate_mps;
    case Phase::compression: {
      const double damping = kind_ == "hop" ? g.stance_damping_N_s_per_m : g.flight_damping_N_s_per_m;
      return compression_N_per_m_ * (g.compression_length_m - leg.value) - damping * rate_mps;
    }
    case Phase::extension:
      return extension_N_per_m_ * (g.extension_length_m - leg.value) - g.stance_damping_N_s_per_m * rate_mps;
  }
  return 0.0;
}

double Controller::torque_Nm(const Seen& seen) {
  double torque = 0.0;
  if (kind_ == "air_sweep") {
    const double w = 2.0 * std::numbers::pi * sweep_Hz_, p = w * seen.t_s;
    const double ramp = std::min(1.0, seen.t_s / 0.3);
    torque = 20.0 * (sweep_centre_rad_ + ramp * sweep_rad_ * std::sin(p) - seen.angle_rad) +
             0.4 * (ramp * sweep_rad_ * w * std::cos(p) - seen.angle_rate_radps);
  } else {
    const auto leg = hip_over_toe(world_.robot, seen.angle_rad);
    torque = hop_N(seen, leg, leg.first * seen.angle_rate_radps) * leg.first;
  }
  const double limit = 2.0 * world_.drive.torque_limit_Nm;
  torque = std::clamp(torque, -limit, limit);
  return world_.sensors.ideal ? torque : 2.0 * kTorqueStep_Nm * std::round(0.5 * torque / kTorqueStep_Nm);
}

}  // namespace sandhopper::conceal::hopper
