#include "tools/campaign/name_factor.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace sandhopper {
namespace {

constexpr bool is_digit_sign(char c) { return c >= '0' && c <= '9'; }

constexpr bool is_letter_sign(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

std::string_view without_end_blanks(std::string_view text) {
  return text.substr(0, text.find_last_not_of(' ') + 1);
}

std::string_view without_first_blanks(std::string_view text) {
  return text.substr(std::min(text.find_first_not_of(' '), text.size()));
}

template <std::size_t N>
bool any_of_marks(const std::array<std::string_view, N>& marks, auto fits) {
  return std::ranges::any_of(marks, fits);
}

constexpr std::array<std::string_view, 3> kTimes{"*", "\xC3\x97", "\xC2\xB7"};  // * × ·
// A superscript minus, 1, 2, 3, and the first two bytes of 0 and 4 to 9.
constexpr std::array<std::string_view, 5> kRaised{"\xE2\x81\xBB", "\xC2\xB9", "\xC2\xB2", "\xC2\xB3",
                                                  "\xE2\x81"};

bool begins_raised(std::string_view text) {
  return text.starts_with('^') ||
         any_of_marks(kRaised, [&](std::string_view sign) { return text.starts_with(sign); });
}

bool is_power_of_ten(std::string_view digits) {
  double value = 0.0;
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const double power = read.ec == std::errc() && value > 0.0 ? std::log10(value) : 0.0;
  return power != 0.0 && power == std::round(power);
}

// A slash between two numbers is that of a date or of the third of twelve, except in "1/100".
bool is_divided(std::string_view before) {
  if (!before.ends_with('/')) return false;
  const auto dividend = without_end_blanks(before.substr(0, before.size() - 1));
  if (dividend.empty()) return false;
  const bool is_one = dividend.ends_with('1') && (dividend.size() == 1 || dividend.ends_with(" 1"));
  return is_one || !is_digit_sign(dividend.back());
}

// The number of these digits, between the two texts, multiplies or divides.
bool is_factor(std::string_view before, std::string_view digits, std::string_view after) {
  const auto left = without_end_blanks(before), right = without_first_blanks(after);
  if (is_divided(left)) return true;
  if (any_of_marks(kTimes,
                   [&](std::string_view mark) { return left.ends_with(mark) || right.starts_with(mark); }))
    return true;
  const bool behind_x = left.ends_with(" x") || left.ends_with(" X");
  const bool before_x = left.empty() && (right.starts_with("x ") || right.starts_with("X "));
  if ((behind_x || before_x) && is_power_of_ten(digits)) return true;
  const bool begins = before.empty() || before.ends_with(' ');
  if (begins && digits == "10" && begins_raised(after)) return true;
  const bool is_exponent = after.size() > 1 && (after[0] == 'e' || after[0] == 'E') &&
                           (is_digit_sign(after[1]) || ((after[1] == '-' || after[1] == '+') &&
                                                        after.size() > 2 && is_digit_sign(after[2])));
  return begins && is_exponent;
}

}  // namespace

bool name_holds_factor(std::string_view name) {
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (i > 0 && is_letter_sign(name[i - 1]) && begins_raised(name.substr(i))) return true;
    if (!is_digit_sign(name[i])) continue;
    std::size_t end = i;
    while (end < name.size() && (is_digit_sign(name[end]) ||
                                 (name[end] == '.' && end + 1 < name.size() && is_digit_sign(name[end + 1]))))
      ++end;
    if (is_factor(name.substr(0, i), name.substr(i, end - i), name.substr(end))) return true;
    i = end - 1;
  }
  return false;
}

}  // namespace sandhopper
