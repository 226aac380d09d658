#include "tools/campaign/available.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "tools/campaign/config_number.hpp"

namespace sandhopper {
namespace {

using Kind = ConfigNode::Kind;

std::optional<double> finite_number_in(const ConfigNode* node) {
  const auto number = node == nullptr ? std::nullopt : number_of(*node);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

std::optional<AvailableValues> range_in(const ConfigNode& node) {
  const auto from = finite_number_in(node.find("from")), to = finite_number_in(node.find("to"));
  if (!from || !to || *from > *to || node.children.size() != 2) return std::nullopt;
  return AvailableValues{{*from, *to}, true, {}};
}

std::optional<AvailableValues> list_in(const ConfigNode& node) {
  AvailableValues list;
  for (const auto& child : node.children)
    if (const auto number = finite_number_in(&child))
      list.values.push_back(*number);
    else if (child.kind == Kind::text && !child.text.empty())
      list.words.push_back(child.text);
    else
      return std::nullopt;
  std::ranges::sort(list.values);
  const bool mixed = !list.values.empty() && !list.words.empty();
  return mixed || node.children.empty() ? std::nullopt : std::optional(list);
}

}  // namespace

Available read_available(const ConfigNode& table, const std::string& file, std::vector<Finding>& findings) {
  Available available;
  for (const auto& child : table.children) {
    const auto values = child.kind == Kind::table   ? range_in(child)
                        : child.kind == Kind::array ? list_in(child)
                                                    : std::nullopt;
    if (values) {
      available[child.key] = *values;
      continue;
    }
    findings.push_back(
        {FindingKind::set_up, FindingSeverity::note, file, child.key_position.line, child.key_position.column,
         "available." + child.key, "cannot be understood and is left out",
         fmt::format("write {0} = [1.0, 2.0] for these values, {0} = {{ from = 1.0, to = 2.0 }} "
                     "for any in between, or a list of words",
                     child.key)});
  }
  return available;
}

}  // namespace sandhopper
