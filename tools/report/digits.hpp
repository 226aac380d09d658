#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace sandhopper {

// A value to two digits of its uncertainty (a standard deviation, or half an interval), so that no digit is
// shown that nobody knows: 0.1688 +- 0.13 is "0.17", 12346 +- 130 is "12350". A value that is rounded to zero
// is "0". Empty without an uncertainty.
inline std::optional<std::string> digits_by(double value, double uncertainty) {
  if (!(uncertainty > 0.0) || !std::isfinite(uncertainty) || !std::isfinite(value)) return std::nullopt;
  constexpr double kLeastShare = 1e-6;  // A smaller interval is rounding, not knowledge.
  if (uncertainty < kLeastShare * std::abs(value) || uncertainty < 1e-300) return std::nullopt;
  constexpr int kMostDecimals = 6;
  const int place = static_cast<int>(std::floor(std::log10(uncertainty))) - 1;  // of the last digit shown
  const double unit = std::pow(10.0, place), rounded = unit * std::round(value / unit);
  if (rounded == 0.0) return "0";
  if (place >= 0) return fmt::format("{:.0f}", rounded);
  if (-place <= kMostDecimals) return fmt::format("{:.{}f}", rounded, -place);
  const int first = static_cast<int>(std::floor(std::log10(std::abs(rounded))));
  return fmt::format("{:.{}e}", rounded, std::max(0, first - place));
}

// A value to so many significant digits, without an exponent from 1e-4 to `most`: 8542 to two digits is
// "8500", not "8.5e+03". Above and below, zeros would have to be counted.
inline std::string plain_number(double value, int digits, double most = 1e6) {
  auto text = fmt::format("{:.{}g}", value, digits);
  if (text.find('e') == std::string::npos) return text;
  const double rounded = std::stod(text), size = std::abs(rounded);
  return size >= 1.0 && size < most ? fmt::format("{:.0f}", rounded) : text;
}

// The same with its sign: "+0.12", "-0.12".
inline std::string signed_number(double value, int digits) {
  return (value < 0.0 ? "" : "+") + plain_number(value, digits);
}

}  // namespace sandhopper
