#include "tools/trial/trace/time_digits.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace sandhopper::trace {

void TimeDigits::see(std::string_view line) {
  const auto close = line.find(')');
  const auto point = line.find('.');
  if (!line.starts_with('(') || close == std::string_view::npos || point > close) return;
  const auto fraction = line.substr(point + 1, close - point - 1);
  shortest_ = std::min(shortest_, fraction.size());
  longest_ = std::max(longest_, fraction.size());
  if (fraction.size() < 2) return;  // a single 0 is written by both
  leading_zero_ |= fraction.front() == '0';
  trailing_zero_ |= fraction.back() == '0';
}

Findings TimeDigits::findings(std::string_view file) const {
  if (!unpadded()) return {};
  const std::size_t digits = longest_ <= 3 ? 3 : longest_ <= 6 ? 6 : 9;
  const char* const unit = digits == 3 ? "milliseconds" : digits == 6 ? "microseconds" : "nanoseconds";
  return {
      {"unpadded_times",
       fmt::format("the fractions of the times have {} to {} digits and none begins with 0: they are whole "
                   "{} without their leading zeros, so .260 means 260 of them and is read as 0.26 s",
                   shortest_, longest_, unit),
       fmt::format("write the zeros: awk -F'[.)]' '/^[(]/ {{ sub(/[.][0-9]+[)]/, sprintf(\".%0{}d)\", $2)) "
                   "}} 1' '{}' > padded.log",
                   digits, file),
       false}};
}

}  // namespace sandhopper::trace
