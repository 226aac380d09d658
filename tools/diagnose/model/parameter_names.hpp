#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/diagnose/model/effect.hpp"

namespace sandhopper::diagnose {

// Name of the change of a number of the belief: "mass_kg" -> "mass_change_kg".
std::string change_of(const std::string& name);

// The names under which [effects] may state a parameter: all that an answer prints of it and that give it
// alone. Its own name first, then its change, then its size under another name.
std::vector<std::string> names_in_effects(const EffectParameter& parameter);

// The parameter's value from [effects], under any of these names; empty if none of them stands there.
std::optional<double> given_value(const EffectParameter& parameter,
                                  const std::map<std::string, double>& given);

}  // namespace sandhopper::diagnose
