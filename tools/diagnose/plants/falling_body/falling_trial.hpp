#pragma once
#include <memory>

#include "tools/diagnose/model/plant.hpp"

namespace sandhopper::diagnose {

// Phases of a fall, by their index in the plant's phases().
enum FallPhase : std::uint32_t { kHeld, kSlow, kFast, kBed, kEntry, kImmersed };

// True if the belief states a liquid's surface, or the accelerometer recorded the impact on one.
bool meets_a_liquid(const Trial& trial, const Belief& belief);

// One drop or throw: release, fall, and stop on a bed or entry into a liquid, as recorded.
std::unique_ptr<TrialModel> make_falling_trial(const Trial& trial, const Belief& belief);

}  // namespace sandhopper::diagnose
