#include "tools/campaign/draft_mappings.hpp"

#include <fmt/format.h>

#include "tools/campaign/unit_check.hpp"
#include "tools/campaign/used_column.hpp"

namespace sandhopper {

std::string draft_mapping(std::string_view channel, const std::string& column, std::string_view unit,
                          double scale, double offset, const std::string& plus) {
  const std::string number = fmt::format("{:.12g}", scale);
  const bool real = number.find_first_of(".e") != std::string::npos;
  std::string how = fmt::format("unit = \"{}\"", unit);
  if (scale < 0.0) how = fmt::format("scale = {}{}", number, real ? "" : ".0");
  if (scale < 0.0 && unit == kUnknownUnit) how = fmt::format("unit = \"{}\", {}", kUnknownUnit, how);
  return fmt::format("{} = {{ column = {}, {}{}{} }}\n", channel, toml_text(column), how,
                     offset == 0.0 ? "" : fmt::format(", offset = {}", offset), plus);
}

std::string draft_torque(const std::string& column, const std::string& unit) {
  return fmt::format(
      "torque_Nm = {{ column = {}, unit = {}, scale = \"?\" }}   # a current: write the torque constant at "
      "the axis, in N m per {}; if this is not the motor's current, remove the line\n",
      toml_text(column), toml_text(unit), unit);
}

}  // namespace sandhopper
