#include "tools/campaign/unit_check.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tools/campaign/name_factor.hpp"
#include "tools/campaign/unit_text.hpp"

namespace sandhopper {
namespace {

bool same(double a, double b) { return std::abs(std::abs(a) / std::abs(b) - 1.0) < kSameScale; }

std::string mapping(const ColumnUnits& c, std::string_view unit, double scale) {
  return fmt::format("{} = {{ column = \"{}\", unit = \"{}\", scale = {:.9g} }}", c.channel, c.column, unit,
                     scale);
}

bool by_unit_alone(const ColumnUnits& c) { return !c.has_scale && !c.stated_unit.empty(); }

// Example: "23.59 mm are 0.02359 m, and scale = -1 makes 23.59 m of them".
std::string arithmetic(const ColumnUnits& c, const WrittenUnit& unit, const WrittenUnit& wanted,
                       double factor) {
  const auto claim =
      by_unit_alone(c) ? fmt::format("unit = \"{}\"", c.stated_unit) : fmt::format("scale = {:.6g}", c.scale);
  return fmt::format("{:.4g} {} are {:.4g} {}, and {} makes {:.4g} {} of them", c.largest, unit.text,
                     c.largest * factor, wanted.text, claim, c.largest * std::abs(c.scale), wanted.text);
}

// `other`: unit of the numbers if c.scale is right.
UnitVerdict disagreement(const ColumnUnits& c, const WrittenUnit& unit, const WrittenUnit& wanted,
                         double factor, std::string_view where, const std::string& other) {
  const double sign = c.scale < 0.0 ? -1.0 : 1.0;
  const auto claim = by_unit_alone(c) ? fmt::format("unit = \"{}\" alone", c.stated_unit)
                                      : fmt::format("scale = {:.6g} to {}", c.scale, wanted.text);
  return {c.scale,
          fmt::format("{} \"{}\", which does not fit {}: {}", where, unit.text, claim,
                      arithmetic(c, unit, wanted, factor)),
          fmt::format("say which in [columns]: {}, or, if the numbers are in {} after all, {}",
                      mapping(c, unit.text, sign * factor), other, mapping(c, other, c.scale))};
}

// Example: ", an angle".
std::string dimension_of(const WrittenUnit& unit) {
  if (unit.dimension.empty()) return ", which is no unit known here";
  const bool vowel = std::string_view("aeiou").find(unit.dimension.front()) != std::string_view::npos;
  return fmt::format(", {} {}", vowel ? "an" : "a", unit.dimension);
}

UnitVerdict other_dimension(const ColumnUnits& c, const WrittenUnit& unit, const WrittenUnit& wanted,
                            std::string_view where) {
  return {c.scale,
          fmt::format("{} \"{}\"{}, the channel is in {}", where, unit.text, dimension_of(unit), wanted.text),
          fmt::format(
              "say how many {} one {} is: {} = {{ column = \"{}\", unit = \"{}\", scale = … }} in [columns]",
              wanted.text, unit.text, c.channel, c.column, unit.text)};
}

// "Force x10 (N)" may hold ten times the force in N, or the number of 10 N.
UnitVerdict factor_in_name(const ColumnUnits& c, const WrittenUnit& unit, const WrittenUnit& wanted,
                           std::string_view where) {
  return {c.scale,
          fmt::format("{} \"{}\", a unit beside a factor: the numbers may be so many times, or that part of, "
                      "what they would be in the unit",
                      where, unit.text),
          fmt::format(
              "say how many {} the number 1 stands for: {} = {{ column = \"{}\", unit = \"{}\", scale = … }} "
              "in [columns]",
              wanted.text, c.channel, c.column, unit.text)};
}

// A scale that is only that of the unit in the brackets, or in the row of units, leaves the factor open.
bool leaves_factor_open(const ColumnUnits& c, const WrittenUnit& wanted) {
  if (!c.has_scale || same(c.scale, 1.0)) return true;
  const auto unit = c.row_unit.empty() ? read_unit(text_in_brackets(c.column).value_or(""), true)
                                       : read_unit(c.row_unit, true);
  const auto factor = unit ? factor_between(*unit, wanted) : std::nullopt;
  return factor && same(c.scale, *factor);
}

// `unit` without `scale` does not overrule the file: it may be the channel's unit, copied from an example.
UnitVerdict stated_alone(ColumnUnits c, double factor, const WrittenUnit& wanted) {
  c.scale = factor;
  const auto [unit, where] = unit_in_file(c);
  if (!unit) return {.scale = factor};
  // An unknown word contradicts nothing, but a factor does: unit = "N" for "F (N, x1000)" says nothing of it.
  if (unit->beside_factor) return factor_in_name(c, *unit, wanted, where);
  if (unit->dimension.empty() && !holds_factor(unit->text)) return {.scale = factor};
  if (const auto files = factor_between(*unit, wanted))
    return same(factor, *files) ? UnitVerdict{.scale = factor}
                                : disagreement(c, *unit, wanted, *files, where, c.stated_unit);
  if (!unit->is_certain) return {.scale = factor};
  auto verdict = other_dimension(c, *unit, wanted, where);
  verdict.problem += fmt::format(", and unit = \"{}\" alone does not settle it", c.stated_unit);
  verdict.cure += fmt::format(", or, if the numbers are in {} after all, {}; or name another column",
                              c.stated_unit, mapping(c, c.stated_unit, factor));
  return verdict;
}

// Example: "its name says "deg", and [columns] unit = "rad", scale = 1: 19.86 deg would be 0.3466 rad".
std::string overruled(const ColumnUnits& c, double factor, const WrittenUnit& wanted) {
  const auto [unit, where] = unit_in_file(c);
  if (!unit || !unit->is_certain) return "";
  const auto files = factor_between(*unit, wanted);
  if (!files || same(factor, *files) || same(c.scale, *files)) return "";
  return fmt::format(
      "{} \"{}\", and [columns] overrules it with unit = \"{}\", scale = {:.6g}: {:.4g} {} "
      "would be {:.4g} {}, and are taken as {:.4g} {}",
      where, unit->text, c.stated_unit, c.scale, c.largest, unit->text, c.largest * *files, wanted.text,
      c.largest * std::abs(c.scale), wanted.text);
}

UnitVerdict stated(const ColumnUnits& c, const WrittenUnit& wanted) {
  const auto unit = read_unit(c.stated_unit, true);
  const auto factor = unit ? factor_between(*unit, wanted) : std::nullopt;
  if (!factor) {
    if (c.has_scale) return {.scale = c.scale};
    const WrittenUnit none{c.stated_unit, unit ? unit->dimension : "", 0.0};
    return other_dimension(c, none, wanted, "is stated in");
  }
  if (!c.has_scale) return stated_alone(c, *factor, wanted);
  const bool contradicts = !same(c.scale, *factor) && is_ratio_of_units(c.scale / *factor, wanted.dimension);
  if (contradicts) return disagreement(c, *unit, wanted, *factor, "its mapping states the unit", wanted.text);
  return {.scale = c.scale, .overruled = overruled(c, *factor, wanted)};
}

}  // namespace

FilesUnit unit_in_file(const ColumnUnits& c) {
  if (auto unit = c.row_unit.empty() ? std::nullopt : read_unit(c.row_unit, true);
      unit && c.column != c.channel && name_holds_factor(without_brackets(c.column)))
    return {unit_beside_factor(c.column, unit->text), "its name and unit say"};
  else if (unit)
    return {std::move(unit), c.row_source.empty() ? "the row of units says" : c.row_source};
  return {c.column == c.channel ? std::nullopt : unit_in_name(c.column), "its name says"};
}

UnitVerdict check_unit(const ColumnUnits& c) {
  const auto wanted = unit_of_channel(c.channel);
  if (c.stated_unit == kUnknownUnit)
    return {c.scale, "neither the file nor campaign.toml states its unit",
            fmt::format(
                "write its unit in place of \"?\" in [columns]: {} = {{ column = \"{}\", unit = \"{}\" }}",
                c.channel, c.column, wanted ? wanted->text : "…")};
  if (!wanted) return {.scale = c.scale};
  if (!c.stated_unit.empty()) return stated(c, *wanted);
  const auto [unit, where] = unit_in_file(c);
  if (!unit) return {.scale = c.scale};
  if (unit->beside_factor && leaves_factor_open(c, *wanted)) return factor_in_name(c, *unit, *wanted, where);
  const auto factor = factor_between(*unit, *wanted);
  if (!factor) {
    if (!unit->is_certain || (c.has_scale && !same(c.scale, 1.0))) return {.scale = c.scale};
    return other_dimension(c, *unit, *wanted, where);
  }
  if (same(c.scale, *factor)) return {.scale = c.scale};
  return disagreement(c, *unit, *wanted, *factor, where, wanted->text);
}

}  // namespace sandhopper
