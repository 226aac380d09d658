#pragma once
#include "tools/diagnose/context.hpp"
#include "tools/diagnose/diagnosis.hpp"
#include "tools/diagnose/effect.hpp"

namespace sandhopper::diagnose {

// nominal.toml with what was found in place, so that a second run starts from it. An effect that no key of
// nominal.toml expresses stands in it as a comment with its equation and values.
std::string corrected_model(const Belief& belief, const std::vector<Effect>& effects,
                            const Diagnosis& diagnosis);

}  // namespace sandhopper::diagnose
