#pragma once
#include <optional>

#include "firmware/controller_config.hpp"
#include "firmware/event.hpp"
#include "firmware/records.hpp"

// Phases of the hop (Raibert's stance/flight machine with a stiffness step) and the leg's force law in each.
namespace sandhopper {

// Inputs of the phase decisions. Heights are over the undisturbed surface.
struct LegObservation {
  double leg_length_m;
  double leg_rate_mps;
  double foot_z_m;
  double body_velocity_mps;
  double surface_z_m;  // expected height of the ground
};

struct Transition {
  State to;
  EventKind event;
  Reason reason;
};

// flight -> compression if the foot is near the ground, the body falls, and the leg is shortened or shortens;
// compression -> extension when a leg that was compressed begins to lengthen;
// extension -> flight when the leg has reached its extension length.
std::optional<Transition> next_phase(State state, const LegObservation& leg,
                                     const ControllerConfig& config) noexcept;

struct SpringLaw {
  double stiffness_N_per_m;
  double neutral_length_m;
  double damping_N_s_per_m;
};
SpringLaw spring_law(State state, const ControllerConfig& config) noexcept;

// F = K (L0 - L) - B dL/dt [N], pushing body and foot apart.
inline double spring_force_N(const SpringLaw& law, const LegObservation& leg) noexcept {
  return law.stiffness_N_per_m * (law.neutral_length_m - leg.leg_length_m) -
         law.damping_N_s_per_m * leg.leg_rate_mps;
}

}  // namespace sandhopper
