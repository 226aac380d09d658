#pragma once
#include <string>

#include "tools/diagnose/answer/diagnosis.hpp"
#include "tools/diagnose/fit/prepare.hpp"

namespace sandhopper::diagnose {

// nominal.toml with what was found in place, so that a second run starts from it: as keys of nominal.toml
// where they can say it and no trial's set-up overrides them, else under [effects] (tools/campaign). What was
// found outside the list of effects stands in it as a comment; empty where there is nothing but that.
std::string corrected_model(const Recordings& recordings, const Problem& problem, const Diagnosis& diagnosis);

}  // namespace sandhopper::diagnose
