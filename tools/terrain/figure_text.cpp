#include "tools/terrain/figure_text.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <filesystem>

#include "config/hint.hpp"
#include "tools/report/digits.hpp"
#include "tools/report/unit_text.hpp"

namespace sandhopper {

std::string rounded_text(double value) {
  // A little more than a tenth, so that a power of ten does not fall below its decade by rounding.
  return digits_by(value, 0.1001 * std::abs(value)).value_or(figure_number(value));
}

std::string figure_number(double value) {
  if (!std::isfinite(value)) return "–";
  // Figures are of the order of 1 in their units: what is smaller than this is the rounding of their sums.
  constexpr double kRounding = 1e-9;
  return std::abs(value) < kRounding ? "0" : plain_number(value, 4, 1e7);
}

std::string interval_text(double low, double high) {
  if (!std::isfinite(low) || !std::isfinite(high)) return "no interval";
  return fmt::format("{} to {}", value_text(low, low, high), value_text(high, low, high));
}

std::string with_interval(double value, double low, double high) {
  const auto text = value_text(value, low, high);
  if (!std::isfinite(low) || !std::isfinite(high)) return text;
  return fmt::format("{} [{}, {}]", text, value_text(low, low, high), value_text(high, low, high));
}

std::string value_text(double value, double low, double high) {
  return digits_by(value, 0.5 * (high - low)).value_or(figure_number(value));
}

std::string figure_title(std::string_view name) {
  const auto unit = split_unit(name);
  std::string title(unit ? unit->quantity : name);
  for (char& c : title)
    if (c == '_') c = ' ';
  for (const std::string_view fit : {" ols", " wls"})  // the names of fits are in upper case everywhere
    if (const auto at = title.find(fit); at != std::string::npos)
      for (std::size_t i = at; i < at + fit.size(); ++i)
        title[i] = static_cast<char>(std::toupper(static_cast<unsigned char>(title[i])));
  return title;
}

double page_scale(std::string_view name) {
  const bool height = name.find("depth") != std::string_view::npos ||
                      name.find("height") != std::string_view::npos ||
                      name.find("diameter") != std::string_view::npos;
  return height && name.ends_with("_m") ? 1e3 : 1.0;
}

std::string figure_unit(std::string_view name) {
  if (page_scale(name) != 1.0) return "mm";
  const auto unit = unit_of_key(name);
  return unit.empty() ? "–" : with_powers(std::string(unit));
}

std::string trial_label(std::string_view trial) { return std::filesystem::path(trial).stem().string(); }

std::string_view cost_text(FindingSeverity severity) {
  switch (severity) {
    case FindingSeverity::note:
      return "nothing more";
    case FindingSeverity::channel_unusable:
      return "the channel";
    case FindingSeverity::trial_unusable:
      return "the trial";
  }
  return "";
}

}  // namespace sandhopper
