#pragma once
#include <array>
#include <string>
#include <vector>

#include "estimation/leg.hpp"
#include "tools/diagnose/plants/hopper/hopper_simulation.hpp"
#include "tools/diagnose/plants/inputs.hpp"

// Course of a recorded hop trial: its release, its phase changes and the start of each hop.
namespace sandhopper::diagnose {

inline constexpr double kTick_s = 1e-3;  // cycle of the hopper's controller

// State of the plant at the start of a hop.
struct HopStart {
  double from_s = 0.0;
  PlantState state{};
  double crater_m = 0.0;  // deepest point of earlier strides
  bool at_rest = false;   // released from the catch: the set-up gives the state
};

struct HopperCourse {
  std::vector<PhaseChange> phases;
  std::vector<HopStart> hops;  // the first is the release or the start of the recording
  double end_s = 0.0;
};

// Recorded phase changes; the first is the phase at the start.
std::vector<PhaseChange> phase_changes(const Trial& trial);

// Sum of both motors' torque commands. Empty if they were not recorded.
Samples commands_of(const Trial& trial);

// Leg angle and rate as the controller measured them: mean of both motors.
struct MeasuredLeg {
  std::vector<double> time_s, angle_rad, rate_radps;
};
MeasuredLeg measured_leg(const Trial& trial);

// The course ends in the middle of the flight after the first stance. `flight_length_m`: leg length at the
// release.
HopperCourse course_of(const Trial& trial, const Leg& leg, double flight_length_m);

// The phase changes at the cycles of a controller that runs every `cycle_s` from the start of each hop: a
// recorded change belongs to the cycle that is nearest to its time stamp, which may be early or late by less
// than half a cycle.
std::vector<PhaseChange> at_cycles(const HopperCourse& course, double cycle_s);

// True if the currents of a row follow the command of the same row, and not that of the row before. Mostly a
// drive replies before it receives a row's command. Decided by a regression of the current on each command:
// one must leave half of what the other leaves. False if they were not recorded.
bool currents_follow_own_row(const Trial& trial);

// The trial of a recorder that writes commands and phases in the row after the cycle that they belong to:
// both moved to the row before.
Trial with_commands_a_row_earlier(Trial trial);

// Mean of both motors, or the value of the one that was recorded.
Samples mean_of_motors(const Trial& trial, const std::string& quantity);

}  // namespace sandhopper::diagnose
