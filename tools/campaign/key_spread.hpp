#pragma once
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "config/node.hpp"
#include "config/problem.hpp"

namespace sandhopper {

// How far one number of the belief differs from trial to trial, where [spread] names that number:
//
//   [spread]
//   coulomb_friction_relative = 0.05    # of axis.coulomb_friction_Nm, as a share of it
//   mass_kg                   = 0.002   # of body.mass_kg, in its own unit
// or how well it is known, where it is one and the same in all trials:
//
//   [known_to]
//   inertia_relative = 0.015            # of axis.inertia_kg_m2
struct KeySpread {
  std::string name;  // as [spread] writes it
  std::string key;   // of the number, "axis.coulomb_friction_Nm"
  double sd = 0.0;   // one standard deviation
  bool is_relative = false;
};

// True for "spread.…" and "known_to.…": numbers that say how well others are known.
bool states_uncertainty(std::string_view path);

// Takes out of `table`, [spread] or [known_to], every key that is not among `known` and names exactly one of
// `numbers` ("table.key" and value). A value that is negative or no number is a problem with its place.
std::vector<KeySpread> take_key_spreads(ConfigNode& table, const std::vector<std::string>& known,
                                        const std::map<std::string, double>& numbers, const std::string& file,
                                        std::vector<ConfigProblem>& problems);

}  // namespace sandhopper
