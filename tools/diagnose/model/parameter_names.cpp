#include "tools/diagnose/model/parameter_names.hpp"

namespace sandhopper::diagnose {
namespace {

bool has_change(const EffectParameter& p) { return p.scale != 0.0 && p.power == 1.0; }

}  // namespace

std::string change_of(const std::string& name) {
  for (const char* unit :
       {"_N_s2_per_m2", "_N_s_per_m", "_N_per_m3", "_N_per_m", "_Nm_per_A", "_Nm_s2", "_Nm_s", "_kg_m2",
        "_radps", "_mps2", "_mps", "_rad", "_Nm", "_kg", "_N", "_m", "_s"})
    if (name.ends_with(unit))
      return name.substr(0, name.size() - std::string(unit).size()) + "_change" + unit;
  return name + "_change";
}

std::vector<std::string> names_in_effects(const EffectParameter& p) {
  std::vector<std::string> names{p.name};
  if (has_change(p)) names.push_back(change_of(p.name));
  if (has_change(p) && !p.other_name.empty()) names.push_back(p.other_name);
  return names;
}

std::optional<double> given_value(const EffectParameter& p, const std::map<std::string, double>& given) {
  if (const auto own = given.find(p.name); own != given.end()) return p.value_of(own->second);
  if (!has_change(p)) return std::nullopt;
  if (const auto change = given.find(change_of(p.name)); change != given.end())
    return p.value_of(p.base + change->second);
  if (const auto other = given.find(p.other_name); other != given.end() && !p.other_name.empty())
    return other->second / p.other_scale;
  return std::nullopt;
}

}  // namespace sandhopper::diagnose
