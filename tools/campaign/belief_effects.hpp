#pragma once
#include <map>
#include <string>
#include <vector>

#include "config/node.hpp"
#include "config/problem.hpp"

namespace sandhopper {

// Effects that no key of nominal.toml can express, as written by `hop diagnose` into corrected.toml: name of
// the effect, channel of the sensor in brackets, parameters. A second effect of the same name gets a '#' and
// a number.
//
//   [effects]
//   "axis.stribeck"        = { stribeck_torque_Nm = 0.05, stribeck_speed_radps = 0.6 }
//   "clock.skew[force_N]"  = { skew_s = 0.002 }
//   "axis.stribeck#2"      = { stribeck_torque_Nm = 0.01, stribeck_speed_radps = 2.0 }
using BeliefEffects = std::map<std::string, std::map<std::string, double>>;

// Removes the table [effects] from the document and returns it. Values that are not numbers are added to
// `problems`.
BeliefEffects take_effects(ConfigDocument& document, std::vector<ConfigProblem>& problems);

}  // namespace sandhopper
