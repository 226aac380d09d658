#pragma once
#include <string>

#include "tools/diagnose/answer/diagnosis.hpp"

namespace sandhopper::diagnose {

// The verdict as a sentence.
std::string headline(const Diagnosis& diagnosis);

double simulations_per_second(const Diagnosis& diagnosis);

// The answer for people: verdict, what, where, how much better, what next, the bounds that matter.
std::string to_text(const Diagnosis& diagnosis);

}  // namespace sandhopper::diagnose
