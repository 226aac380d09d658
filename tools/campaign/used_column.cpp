#include "tools/campaign/used_column.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace sandhopper {
namespace {

// Name of the unit whose factor to the channel's unit is `scale`; empty if there is none.
std::string unit_by_scale(std::string_view channel, double scale) {
  constexpr std::array kUsual{"m",    "mm",    "cm",    "in",  "ft",     "um",    "rad",  "deg",  "rev",
                              "mrad", "rad/s", "deg/s", "rpm", "rev/s",  "m/s",   "mm/s", "cm/s", "in/s",
                              "ft/s", "km/h",  "m/s^2", "g",   "mm/s^2", "N",     "kN",   "mN",   "kgf",
                              "lbf",  "gf",    "N m",   "mNm", "kNm",    "s",     "ms",   "us",   "ns",
                              "min",  "Pa",    "kPa",   "A",   "mA",     "mrad/s"};
  const auto wanted = unit_of_channel(channel);
  if (!wanted) return "";
  for (const std::string_view name : kUsual) {
    const auto unit = read_unit(name, true);
    const auto factor = unit ? factor_between(*unit, *wanted) : std::nullopt;
    if (factor && std::abs(std::abs(scale) / *factor - 1.0) < kSameScale) return std::string(name);
  }
  return "";
}

}  // namespace

UsedColumn used_column(const ColumnUnits& c, double scale, double offset, bool is_stated) {
  UsedColumn used{c.channel, c.column, "", scale, offset, false, is_stated};
  const auto wanted = unit_of_channel(c.channel);
  const auto fits = [&](const std::optional<WrittenUnit>& unit) {
    const auto factor = unit && wanted ? factor_between(*unit, *wanted) : std::nullopt;
    return factor && std::abs(std::abs(scale / *factor) - 1.0) < kSameScale;
  };
  const auto file = unit_in_file(c).unit;
  used.in_file = fits(file) && c.column != c.channel;
  const bool states_unit = !c.stated_unit.empty() && c.stated_unit != kUnknownUnit;
  used.unit = states_unit ? c.stated_unit : fits(file) ? file->text : unit_by_scale(c.channel, scale);
  return used;
}

UsedColumn reversed(UsedColumn column) {
  column.scale = -column.scale;
  column.offset = column.offset == 0.0 ? 0.0 : -column.offset;
  return column;
}

UsedColumn in_other_unit(UsedColumn column, double factor) {
  column.scale *= factor;
  column.unit = unit_by_scale(column.channel, column.scale);
  return column;
}

std::string toml_text(std::string_view text) {
  std::string escaped = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') escaped += '\\';
    escaped += c;
  }
  return escaped + "\"";
}

std::string column_text(const std::string& column, const std::vector<std::string>& added) {
  if (added.empty()) return toml_text(column);
  std::string text = "[" + toml_text(column);
  for (const auto& name : added) text += ", " + toml_text(name);
  return text + "]";
}

std::string mapping_line(const UsedColumn& column) {
  const auto unit = column.unit.empty() ? "" : fmt::format(", unit = {}", toml_text(column.unit));
  const auto offset = column.offset == 0.0 ? "" : fmt::format(", offset = {:.9g}", column.offset);
  return fmt::format("{} = {{ column = {}{}, scale = {:.9g}{} }}", column.channel,
                     column_text(column.column, column.added), unit, column.scale, offset);
}

std::string confirming_line(const UsedColumn& column) {
  UsedColumn as_it_is = column;
  if (as_it_is.unit.empty()) as_it_is.unit = "raw";  // Any word: it makes the scale the user's own.
  return mapping_line(as_it_is);
}

std::string scale_cure(const UsedColumn& column) {
  return fmt::format(
      "correct its unit or scale in [columns]; if the values are right, confirm them there: {}",
      confirming_line(column));
}

}  // namespace sandhopper
