#include "tools/campaign/key_spread.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "config/hint.hpp"

namespace sandhopper {
namespace {

using Kind = ConfigNode::Kind;

constexpr std::string_view kRelative = "_relative", kDampingUnit = "_Nm_s";

std::string_view without_ending(std::string_view key, std::string_view ending) {
  return key.ends_with(ending) ? key.substr(0, key.size() - ending.size()) : key;
}

// "viscous_friction" of "axis.viscous_friction_Nm_s".
std::string_view quantity_of(std::string_view path) {
  const auto name = path.substr(path.rfind('.') + 1);
  if (name.ends_with(kDampingUnit)) return without_ending(name, kDampingUnit);
  const auto parts = split_unit(name);
  return parts ? parts->quantity : name;
}

bool can_differ(std::string_view path) {
  return !path.starts_with("sensors.") && !path.starts_with("spread.");
}

// Numbers that `name` may mean.
std::vector<std::string> named(std::string_view name, const std::map<std::string, double>& numbers) {
  std::vector<std::string> found;
  for (const auto& [path, value] : numbers) {
    if (!can_differ(path)) continue;
    const bool is_it = name.ends_with(kRelative) ? quantity_of(path) == without_ending(name, kRelative)
                                                 : path.substr(path.rfind('.') + 1) == name;
    if (is_it) found.push_back(path);
  }
  return found;
}

}  // namespace

std::vector<KeySpread> take_key_spreads(ConfigNode& spread, const std::vector<std::string>& known,
                                        const std::map<std::string, double>& numbers, const std::string& file,
                                        std::vector<ConfigProblem>& problems) {
  std::vector<KeySpread> taken;
  std::erase_if(spread.children, [&](const ConfigNode& node) {
    if (std::ranges::find(known, node.key) != known.end()) return false;
    const auto keys = named(node.key, numbers);
    if (keys.size() != 1) return false;
    const bool is_number = node.kind == Kind::real || node.kind == Kind::integer;
    const double sd = node.kind == Kind::integer ? static_cast<double>(node.integer) : node.real;
    if (!is_number || !(sd >= 0.0)) {
      problems.push_back(
          {file, node.position, "spread." + node.key,
           fmt::format("spread.{}: expected a standard deviation of {}, 0 or more", node.key, keys.front())});
      return true;
    }
    taken.push_back({node.key, keys.front(), sd, node.key.ends_with(kRelative)});
    return true;
  });
  return taken;
}

}  // namespace sandhopper
