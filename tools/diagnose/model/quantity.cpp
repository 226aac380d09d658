#include "tools/diagnose/model/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace sandhopper::diagnose {
namespace {

// Longer suffixes first, because "_N" also ends "_m_per_N".
constexpr std::array<std::pair<const char*, const char*>, 28> kUnits{{{"_rad_per_Nm", "rad/(N m)"},
                                                                      {"_N_s2_per_m2", "N s²/m²"},
                                                                      {"_kg_per_m3", "kg/m³"},
                                                                      {"_N_s_per_m", "N s/m"},
                                                                      {"_N_per_m3", "N/m³"},
                                                                      {"_Nm_per_A", "N m/A"},
                                                                      {"_N_per_m", "N/m"},
                                                                      {"_m_per_N", "m/N"},
                                                                      {"_Nm_s2", "N m s²"},
                                                                      {"_kg_m2", "kg m²"},
                                                                      {"_radps", "rad/s"},
                                                                      {"_Nm_s", "N m s"},
                                                                      {"_mps2", "m/s²"},
                                                                      {"_mps", "m/s"},
                                                                      {"_rad", "rad"},
                                                                      {"_Nm", "N m"},
                                                                      {"_kg", "kg"},
                                                                      {"_m2", "m²"},
                                                                      {"_m3", "m³"},
                                                                      {"_Hz", "Hz"},
                                                                      {"_Pa", "Pa"},
                                                                      {"_N", "N"},
                                                                      {"_A", "A"},
                                                                      {"_C", "°C"},
                                                                      {"_V", "V"},
                                                                      {"_m", "m"},
                                                                      {"_s", "s"},
                                                                      {"_J", "J"}}};

}  // namespace

Quantity quantity_of(const std::string& key) {
  if (const auto comma = key.find(", "); comma != std::string::npos) {  // "depth_m, unloading"
    Quantity first = quantity_of(key.substr(0, comma));
    first.words += key.substr(comma);
    return first;
  }
  Quantity q{key, ""};
  for (const auto& [suffix, unit] : kUnits)
    if (key.ends_with(suffix)) {
      q = {key.substr(0, key.size() - std::char_traits<char>::length(suffix)), unit};
      break;
    }
  q.words = in_words(q.words);
  return q;
}

std::string in_words(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

std::string trial_in_words(const std::string& kind, const std::map<std::string, std::string>& words,
                           const std::map<std::string, double>& setup) {
  std::string text = kind;
  for (const auto& [key, word] : words) text += ", " + word;
  for (const auto& [key, value] : setup) {
    if (key == "session") continue;
    const auto q = quantity_of(key);
    text += fmt::format(", {} {}{}", q.words, number(value), q.unit.empty() ? "" : " " + q.unit);
  }
  return text;
}

std::string number(double value) {
  const double magnitude = std::abs(value);
  if (magnitude > 0.0 && (magnitude < 1e-3 || magnitude >= 1e5)) return fmt::format("{:.3g}", value);
  return fmt::format("{:.4g}", value);
}

std::string with_interval(double value, double low, double high, const std::string& unit) {
  const double half = 0.5 * std::abs(high - low);
  const std::string after = unit.empty() ? "" : " " + unit;
  if (!(half > 0.0) || !std::isfinite(half)) return number(value) + after;
  const int digits = 1 - static_cast<int>(std::floor(std::log10(half)));
  if (digits > 6 || digits < -4)
    return fmt::format("{:.4g}{} (95 %: {:.4g} to {:.4g})", value, after, low, high);
  const int shown = std::max(0, digits);
  return fmt::format("{:.{}f}{} (95 %: {:.{}f} to {:.{}f})", value, shown, after, low, shown, high, shown);
}

}  // namespace sandhopper::diagnose
