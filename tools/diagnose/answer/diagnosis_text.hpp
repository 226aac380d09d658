#pragma once
#include <string>

#include "tools/diagnose/answer/diagnosis.hpp"

namespace sandhopper::diagnose {

// The verdict as one sentence.
std::string headline(const Diagnosis& diagnosis);

// Says in words that a limit of time ended the search, and names the parts of the answer that are missing;
// empty if the search was complete.
std::string limit_text(const Diagnosis& diagnosis);

// Size of the rest beyond the noise floor, in the channel's unit, as a share of what was recorded, and
// of what the first model left if the model in use is a corrected one. Empty if nothing unknown is left.
std::string remainder_text(const Diagnosis& diagnosis);

// Says why something is found although no channel's error is clearly above its noise floor; empty otherwise.
std::string below_the_floor(const Diagnosis& diagnosis);

std::string two_digits(double value);  // "1.0", "12", "0.74"

double simulations_per_second(const Diagnosis& diagnosis);

// The answer as text: verdict, effects, places, errors before and after, next trial, the widest bounds,
// notes.
std::string to_text(const Diagnosis& diagnosis);

}  // namespace sandhopper::diagnose
