#pragma once
#include <string>

#include "tools/diagnose/diagnosis.hpp"

namespace sandhopper::diagnose {

// The answer for people: where, what, how sure, how much better, what it could have been instead.
std::string to_text(const Diagnosis& diagnosis);

}  // namespace sandhopper::diagnose
