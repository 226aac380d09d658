#include "firmware/gait.hpp"

namespace sandhopper {
namespace {

std::optional<Transition> leave_flight(const LegObservation& leg, const ControllerConfig& c) noexcept {
  const bool near_ground = leg.foot_z_m <= leg.surface_z_m + c.touchdown_height_margin_m;
  if (!near_ground || leg.body_velocity_mps >= 0.0) return std::nullopt;
  if (c.compression_length_m - leg.leg_length_m > c.touchdown_deflection_m)
    return Transition{State::compression, EventKind::touchdown, Reason::leg_deflection};
  if (leg.leg_rate_mps < -c.touchdown_rate_mps)
    return Transition{State::compression, EventKind::touchdown, Reason::leg_rate};
  return std::nullopt;
}

std::optional<Transition> leave_compression(const LegObservation& leg, const ControllerConfig& c) noexcept {
  const bool compressed = c.compression_length_m - leg.leg_length_m > c.compression_end_min_deflection_m;
  if (!compressed || leg.leg_rate_mps < 0.0) return std::nullopt;
  return Transition{State::extension, EventKind::stance_switch, Reason::leg_rate_reversed};
}

std::optional<Transition> leave_extension(const LegObservation& leg, const ControllerConfig& c) noexcept {
  if (leg.leg_length_m < c.extension_length_m - c.liftoff_margin_m) return std::nullopt;
  return Transition{State::flight, EventKind::liftoff, Reason::leg_extended};
}

}  // namespace

std::optional<Transition> next_phase(State state, const LegObservation& leg,
                                     const ControllerConfig& config) noexcept {
  switch (state) {
    case State::flight:
      return leave_flight(leg, config);
    case State::compression:
      return leave_compression(leg, config);
    case State::extension:
      return leave_extension(leg, config);
    default:
      return std::nullopt;
  }
}

SpringLaw spring_law(State state, const ControllerConfig& c) noexcept {
  switch (state) {
    case State::compression:
      return {c.compression_stiffness_N_per_m, c.compression_length_m, c.stance_damping_N_s_per_m};
    case State::extension:
      return {c.extension_stiffness_N_per_m, c.extension_length_m, c.stance_damping_N_s_per_m};
    case State::soft_stop:
      return {c.flight_stiffness_N_per_m, c.compression_length_m, c.soft_stop_damping_N_s_per_m};
    default:
      return {c.flight_stiffness_N_per_m, c.compression_length_m, c.flight_damping_N_s_per_m};
  }
}

}  // namespace sandhopper
