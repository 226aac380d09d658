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

// Phase change of the recorded controller; [0] is the phase at the start. The changes are imposed on the
// simulation, because a change that moves by one cycle would look like missing physics. If there are none,
// the simulated controller decides.
struct PhaseChange {
  double time_s;
  HopperPhase phase;
  double unsure_s = 0.0;  // It may have come so much earlier or later, because rows are missing there.
};
// Phase at a time; before the first change it is the first phase.
HopperPhase phase_at(const std::vector<PhaseChange>& phases, double time_s);

// Virtual spring, F = K (L0 - L) - B dL/dt, torque of both motors = F L', within the drives' limit.
struct SpringState {
  HopperPhase phase;
  LegKinematics leg;
  double rate_radps;
};
double spring_torque_Nm(const WorldConfig& world, double compression_stiffness_N_per_m,
                        const SpringState& at);

inline constexpr double kHopperStep_s = 5e-4;

// Input of simulate_hopper().
struct HopperRun {
  WorldConfig world{};
  double compression_stiffness_N_per_m = 375.0;
  BedFluctuation fluctuation{};
  double surface_m = 0.0;
  double cable_force_N = 0.0;
  double torque_constant_factor = 1.0;
  double motor_temperature_C = 25.0;
  PlantState start{};     // the angle is as the encoder reads it
  double crater_m = 0.0;  // deepest point of earlier strides
  BedHistory bed_history{};
  double from_s = 0.0, to_s = 1.0;
  double step_s = kHopperStep_s;
  double friction_switch_factor = 1.0;  // Plant::Options
  // True: the command follows a phase change at once, not with the next cycle.
  bool switch_between_cycles = false;
  const std::vector<PhaseChange>* phases = nullptr;
  // Recorded command minus the command that the believed controller computes from the recorded leg, sum of
  // both motors. It is added to what the controller computes from the simulated leg. So the noise that the
  // real controller fed back acts here, too, and the leg remains stable, which it does not if a torque is
  // replayed.
  const Signal* command_residual_Nm = nullptr;
  const Signal* recorded_command_Nm = nullptr;  // drives the leg instead of the controller
};

// Result of a run: quantities on one time grid, heights over the undisturbed surface.
struct HopperTraces {
  Signal angle_rad, rate_radps, current_torque_Nm,
      command_torque_Nm;  // torques: both motors, nominal constant
  Signal body_accel_mps2, foot_accel_mps2, body_z_m, foot_z_m, foot_velocity_mps, force_N;
};

// Simulates the closed loop on a 0.25 ms grid (Plant::advance, midpoint rule). At the controller's rate the
// virtual spring acts on the simulated leg, whose rate it sees through the encoder's low-pass. Its command
// becomes a torque through delay and current loop. The laws of `edits` act at the plant's ports
//   rail    force on the body, up
//   joint   torque on the links, both sides
//   actuator_limit  largest torque of both motors
//   ground_*  as in ground_laws.hpp
// Sensor edits of the channel "actuator": delay and lag act on the current; gain, offset and law act on the
// torque that it makes. Edits of the motors' position (offset, gain, law) also change what the controller
// sees.
HopperTraces simulate_hopper(const HopperRun& run, const Edits& edits);

}  // namespace sandhopper::diagnose
