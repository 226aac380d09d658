#include "tools/campaign/key_spread.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "config/hint.hpp"

namespace sandhopper {
namespace {

using Kind = ConfigNode::Kind;

constexpr std::string_view kRelative = "_relative";

// "viscous_friction" of "viscous_friction_Nm_s".
std::string_view quantity_of(std::string_view key) {
  const auto parts = split_unit(key);
  return parts ? parts->quantity : key;
}

bool can_differ(std::string_view path) { return !path.starts_with("sensors.") && !states_uncertainty(path); }

// Numbers that `name` may mean.
std::vector<std::string> named(std::string_view name, const std::map<std::string, double>& numbers) {
  const bool is_relative = name.ends_with(kRelative);
  if (is_relative) name.remove_suffix(kRelative.size());
  std::vector<std::string> found;
  for (const auto& [path, value] : numbers) {
    const auto key = last_key(path);
    if (can_differ(path) && (is_relative ? quantity_of(key) : key) == name) found.push_back(path);
  }
  return found;
}

}  // namespace

bool states_uncertainty(std::string_view path) {
  return path.starts_with("spread.") || path.starts_with("known_to.");
}

std::vector<KeySpread> take_key_spreads(ConfigNode& table, const std::vector<std::string>& known,
                                        const std::map<std::string, double>& numbers, const std::string& file,
                                        std::vector<ConfigProblem>& problems) {
  std::vector<KeySpread> taken;
  std::erase_if(table.children, [&](const ConfigNode& node) {
    if (std::ranges::find(known, node.key) != known.end()) return false;
    const auto keys = named(node.key, numbers);
    if (keys.size() != 1) return false;
    const bool is_number = node.kind == Kind::real || node.kind == Kind::integer;
    const double sd = node.kind == Kind::integer ? static_cast<double>(node.integer) : node.real;
    if (!is_number || !(sd >= 0.0)) {
      problems.push_back({file, node.position, table.key + "." + node.key,
                          fmt::format("{}.{}: expected a standard deviation of {}, 0 or more", table.key,
                                      node.key, keys.front())});
      return true;
    }
    taken.push_back({node.key, keys.front(), sd, node.key.ends_with(kRelative)});
    return true;
  });
  return taken;
}

}  // namespace sandhopper
