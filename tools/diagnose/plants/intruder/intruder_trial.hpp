#pragma once
#include <memory>

#include "tools/diagnose/model/plant.hpp"
#include "tools/diagnose/plants/inputs.hpp"

namespace sandhopper::diagnose {

// Phases of an intrusion, by their index in the plant's phases().
enum IntrusionPhase : std::uint32_t { kAbove, kLoading, kHold, kUnloading };

// Belief key: share of a trial's extra bed stiffness that its unloading line takes up, too (0: none, 1: all).
inline constexpr const char* kLineFollows = "spread.unloading_follows";

// Number of times the foot goes below a tenth of its greatest depth, after it was above the surface by as
// much.
double pushes_of(const Samples& z);

// One intrusion: the foot moves as recorded, the force is predicted.
std::unique_ptr<TrialModel> make_intruder_trial(const Trial& trial, const Belief& belief);

}  // namespace sandhopper::diagnose
