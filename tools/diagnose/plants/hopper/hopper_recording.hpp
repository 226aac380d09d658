#pragma once
#include <array>
#include <string>
#include <vector>

#include "estimation/leg.hpp"
#include "tools/diagnose/plants/hopper/hopper_simulation.hpp"
#include "tools/diagnose/plants/inputs.hpp"

// What a recorded hop trial says of its own course: when it was released, when phases changed, where each hop
// starts.
namespace sandhopper::diagnose {

inline constexpr double kTick_s = 1e-3;  // of the hopper's controller

struct HopStart {
  double from_s = 0.0;
  PlantState state{};
  double crater_m = 0.0;
  bool at_rest = false;  // released from the catch: known by the set-up
};

struct HopperCourse {
  std::vector<PhaseChange> phases;
  std::vector<HopStart> hops;  // the first is the release or the start of the recording
  double end_s = 0.0;
};

std::vector<PhaseChange> phase_changes(const Trial& trial);

// Both motors' commands together; empty where they were not recorded.
Samples commands_of(const Trial& trial);

// The leg as the controller measured it.
struct MeasuredLeg {
  std::vector<double> time_s, angle_rad, rate_radps;
};
MeasuredLeg measured_leg(const Trial& trial);

HopperCourse course_of(const Trial& trial, const Leg& leg, double flight_length_m);

// Mean of both motors, or the one there is.
Samples mean_of_motors(const Trial& trial, const std::string& quantity);

}  // namespace sandhopper::diagnose
