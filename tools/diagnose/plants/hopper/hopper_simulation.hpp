#pragma once
#include <cstdint>
#include <vector>

#include "terrain/bed.hpp"
#include "tools/diagnose/model/edits.hpp"
#include "tools/diagnose/model/signal.hpp"
#include "tools/diagnose/plants/ground_laws.hpp"
#include "tools/plant/plant.hpp"
#include "tools/plant/world_config.hpp"

namespace sandhopper::diagnose {

enum class HopperPhase : std::uint8_t { flight, compression, extension };

// When the recorded controller changed its phase: [0] is the phase at the start. Imposed on the simulation,
// for a switch that moves by a cycle would look like missing physics; empty: the simulated controller
// decides.
struct PhaseChange {
  double time_s;
  HopperPhase phase;
};
HopperPhase phase_at(const std::vector<PhaseChange>& phases, double time_s);

// Virtual spring, F = K (L0 - L) - B dL/dt, torque of both motors = F L', within the drives' limit.
struct SpringState {
  HopperPhase phase;
  double angle_rad, rate_radps;
};
double spring_torque_Nm(const WorldConfig& world, double compression_stiffness_N_per_m, const Leg& leg,
                        const SpringState& at);

inline constexpr double kHopperStep_s = 2.5e-4;

struct HopperRun {
  WorldConfig world{};
  double compression_stiffness_N_per_m = 375.0;
  BedFluctuation fluctuation{};
  double surface_m = 0.0;
  double cable_force_N = 0.0;
  double torque_constant_factor = 1.0;
  double motor_temperature_C = 25.0;
  PlantState start{};     // its angle as the encoder reads it
  double crater_m = 0.0;  // deepest point of earlier strides
  BedHistory bed_history{};
  double from_s = 0.0, to_s = 1.0;
  double step_s = kHopperStep_s;
  bool switch_between_cycles = false;  // a phase changes at its instant, not with the next cycle
  const std::vector<PhaseChange>* phases = nullptr;
  // Both motors: what was commanded, less what the believed controller makes of the recorded leg. Added to
  // what it makes of the simulated leg: the noise that the controller really fed back acts here, too, and the
  // leg cannot run away as it does when torque is replayed.
  const Signal* command_residual_Nm = nullptr;
  const Signal* recorded_command_Nm = nullptr;  // drives the leg instead of the controller
};

// What a run leaves: quantities on one grid of time, heights over the undisturbed surface.
struct HopperTraces {
  Signal angle_rad, rate_radps, current_torque_Nm,
      command_torque_Nm;  // torques: both motors, nominal constant
  Signal body_accel_mps2, foot_accel_mps2, body_z_m, foot_z_m, foot_velocity_mps, force_N;
};

// Closed loop at the controller's rate on a 0.25 ms grid (RK4): the virtual spring on the simulated leg,
// whose rate the controller sees through the encoder's low-pass, command through delay and current loop to
// torque, the plant with the laws of `edits` at its ports
//   rail    force on the body, up
//   joint   torque on the links, both sides
//   actuator_limit  largest torque of both motors
//   ground_*  as in ground_laws.hpp
// and the sensor edits of the channel "actuator": delay and lag act on the current, gain, offset and law on
// the torque it makes. Edits of the motors' position (offset, gain, law) are what the controller sees, too.
HopperTraces simulate_hopper(const HopperRun& run, const Edits& edits);

}  // namespace sandhopper::diagnose
