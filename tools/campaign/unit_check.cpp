#include "tools/campaign/unit_check.hpp"

#include <fmt/format.h>

#include <cmath>

namespace sandhopper {
namespace {

bool same(double a, double b) { return std::abs(std::abs(a) / std::abs(b) - 1.0) < kSameScale; }

std::string mapping(const ColumnUnits& c, std::string_view unit, double scale) {
  return fmt::format("{} = {{ column = \"{}\", unit = \"{}\", scale = {:.9g} }}", c.channel, c.column, unit,
                     scale);
}

// "23.59 mm are 0.02359 m, and scale = -1 makes 23.59 m of them"
std::string arithmetic(const ColumnUnits& c, const WrittenUnit& unit, const WrittenUnit& wanted,
                       double factor) {
  return fmt::format("{:.4g} {} are {:.4g} {}, and scale = {:.6g} makes {:.4g} {} of them", c.largest,
                     unit.text, c.largest * factor, wanted.text, c.scale, c.largest * std::abs(c.scale),
                     wanted.text);
}

UnitVerdict disagreement(const ColumnUnits& c, const WrittenUnit& unit, const WrittenUnit& wanted,
                         double factor, std::string_view where) {
  const double sign = c.scale < 0.0 ? -1.0 : 1.0;
  return {c.scale,
          fmt::format("{} \"{}\", which does not fit scale = {:.6g} to {}: {}", where, unit.text, c.scale,
                      wanted.text, arithmetic(c, unit, wanted, factor)),
          fmt::format("say which in [columns]: {}, or, if the numbers are in {} after all, {}",
                      mapping(c, unit.text, sign * factor), wanted.text, mapping(c, wanted.text, c.scale))};
}

UnitVerdict other_dimension(const ColumnUnits& c, const WrittenUnit& unit, const WrittenUnit& wanted,
                            std::string_view where) {
  return {c.scale,
          fmt::format("{} \"{}\"{}, the channel is in {}", where, unit.text,
                      unit.dimension.empty() ? ", which is no unit known here"
                                             : fmt::format(", a {}", unit.dimension),
                      wanted.text),
          fmt::format(
              "say how many {} one {} is: {} = {{ column = \"{}\", unit = \"{}\", scale = … }} in [columns]",
              wanted.text, unit.text, c.channel, c.column, unit.text)};
}

UnitVerdict stated(const ColumnUnits& c, const WrittenUnit& wanted) {
  const auto unit = read_unit(c.stated_unit, true);
  const auto factor = unit ? factor_between(*unit, wanted) : std::nullopt;
  if (!factor) {
    if (c.has_scale) return {c.scale, "", ""};
    const WrittenUnit none{c.stated_unit, unit ? unit->dimension : "", 0.0};
    return other_dimension(c, none, wanted, "is stated in");
  }
  if (!c.has_scale) return {*factor, "", ""};
  const bool contradicts = !same(c.scale, *factor) && is_ratio_of_units(c.scale / *factor, wanted.dimension);
  if (contradicts) return disagreement(c, *unit, wanted, *factor, "its mapping states the unit");
  return {c.scale, "", ""};
}

}  // namespace

UnitVerdict check_unit(const ColumnUnits& c) {
  const auto wanted = unit_of_channel(c.channel);
  if (c.stated_unit == kUnknownUnit)
    return {c.scale, "neither the file nor campaign.toml states its unit",
            fmt::format(
                "write its unit in place of \"?\" in [columns]: {} = {{ column = \"{}\", unit = \"{}\" }}",
                c.channel, c.column, wanted ? wanted->text : "…")};
  if (!wanted) return {c.scale, "", ""};
  if (!c.stated_unit.empty()) return stated(c, *wanted);
  const bool has_row = !c.row_unit.empty();
  auto unit = has_row ? read_unit(c.row_unit, true) : std::nullopt;
  const std::string_view where = unit ? "the row of units says" : "its name says";
  if (!unit && c.column != c.channel) unit = unit_in_name(c.column);
  if (!unit) return {c.scale, "", ""};
  const auto factor = factor_between(*unit, *wanted);
  if (!factor) {
    if (!unit->is_certain || (c.has_scale && !same(c.scale, 1.0))) return {c.scale, "", ""};
    return other_dimension(c, *unit, *wanted, where);
  }
  if (same(c.scale, *factor)) return {c.scale, "", ""};
  return disagreement(c, *unit, *wanted, *factor, where);
}

}  // namespace sandhopper
