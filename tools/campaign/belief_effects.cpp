#include "tools/campaign/belief_effects.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace sandhopper {
namespace {

using Kind = ConfigNode::Kind;

void read_effect(const std::string& file, const ConfigNode& node, std::map<std::string, double>& out,
                 std::vector<ConfigProblem>& problems) {
  const auto refuse = [&](ConfigPosition position, const std::string& key) {
    problems.push_back(
        {file, position, key,
         fmt::format("key '{}' has the wrong type: expected \"port.effect\" = {{ parameter = 1.0 }}", key)});
  };
  if (node.kind != Kind::table) return refuse(node.position, "effects." + node.key);
  for (const auto& parameter : node.children) {
    if (parameter.kind == Kind::real)
      out[parameter.key] = parameter.real;
    else if (parameter.kind == Kind::integer)
      out[parameter.key] = static_cast<double>(parameter.integer);
    else
      refuse(parameter.position, "effects." + node.key + "." + parameter.key);
  }
}

}  // namespace

BeliefEffects take_effects(ConfigDocument& document, std::vector<ConfigProblem>& problems) {
  BeliefEffects effects;
  auto& tables = document.root.children;
  const auto table =
      std::find_if(tables.begin(), tables.end(), [](const ConfigNode& n) { return n.key == "effects"; });
  if (table == tables.end()) return effects;
  for (const auto& node : table->children) read_effect(document.name, node, effects[node.key], problems);
  tables.erase(table);
  return effects;
}

}  // namespace sandhopper
