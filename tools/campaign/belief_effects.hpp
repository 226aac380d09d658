#pragma once
#include <map>
#include <string>
#include <vector>

#include "config/node.hpp"
#include "config/problem.hpp"

namespace sandhopper {

// Effects that no key of nominal.toml expresses, as `hop diagnose` writes them into corrected.toml: the
// effect's name, a sensor's channel in brackets, and its parameters. A further effect of the same name
// follows a '#'.
//
//   [effects]
//   "axis.stribeck"        = { stribeck_torque_Nm = 0.05, stribeck_speed_radps = 0.6 }
//   "clock.skew[force_N]"  = { skew_s = 0.002 }
//   "axis.stribeck#2"      = { stribeck_torque_Nm = 0.01, stribeck_speed_radps = 2.0 }
using BeliefEffects = std::map<std::string, std::map<std::string, double>>;

// Takes the table out of the document; what is no number is a problem with its place.
BeliefEffects take_effects(ConfigDocument& document, std::vector<ConfigProblem>& problems);

}  // namespace sandhopper
