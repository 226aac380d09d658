#include "firmware/log/csv_cells.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>

namespace sandhopper {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::optional<double> plain_number(std::string_view digits) {
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  return value;
}

// True for "1,234,567": one to three digits that are not 0, then groups of three.
bool has_groups(std::string_view whole, char mark) {
  auto at = whole.find(mark);
  const std::string_view first = whole.substr(0, at);
  if (first.empty() || first.size() > 3 || first.front() == '0') return false;
  while (at != std::string_view::npos) {
    const auto next = whole.find(mark, at + 1);
    const auto group = whole.substr(at + 1, next == std::string_view::npos ? next : next - at - 1);
    if (group.size() != 3 || !std::all_of(group.begin(), group.end(), is_digit)) return false;
    at = next;
  }
  return true;
}

// Reads the parts of a date or time one after the other.
class TimeReader {
 public:
  explicit TimeReader(std::string_view text) : rest_(text) {}

  std::optional<int> number(std::size_t most_digits) {
    std::size_t n = 0;
    while (n < std::min(most_digits, rest_.size()) && is_digit(rest_[n])) ++n;
    int value = 0;
    if (n == 0 || std::from_chars(rest_.data(), rest_.data() + n, value).ec != std::errc{})
      return std::nullopt;
    rest_.remove_prefix(n);
    return value;
  }
  bool mark(std::string_view any_of) {
    if (rest_.empty() || any_of.find(rest_.front()) == std::string_view::npos) return false;
    rest_.remove_prefix(1);
    return true;
  }
  bool word(std::string_view upper) {
    const auto same = [](char a, char b) { return (a | 0x20) == (b | 0x20); };
    if (rest_.size() < upper.size() || !std::equal(upper.begin(), upper.end(), rest_.begin(), same))
      return false;
    rest_.remove_prefix(upper.size());
    return true;
  }
  double fraction() {
    double value = 0.0, place = 0.1;
    while (!rest_.empty() && is_digit(rest_.front())) {
      value += place * (rest_.front() - '0');
      place *= 0.1;
      rest_.remove_prefix(1);
    }
    return value;
  }
  void blanks() {
    while (mark(" \t")) continue;
  }
  bool at_end() const { return rest_.empty(); }
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
};

// Days since 1970-01-01.
std::optional<double> days_in(TimeReader& in) {
  const auto first = in.number(4);
  if (!first) return std::nullopt;
  const char mark = in.rest().empty() ? '\0' : in.rest().front();
  if (!in.mark("-/.")) return std::nullopt;
  const auto second = in.number(2);
  if (!second || in.rest().empty() || in.rest().front() != mark || !in.mark("-/.")) return std::nullopt;
  const auto third = in.number(4);
  if (!third) return std::nullopt;
  int year = *third, month = *first, day = *second;
  if (*first > 31) {
    year = *first, month = *second, day = *third;
  } else if (mark != '/' || *first > 12) {
    day = *first, month = *second;
  }
  if (year < 100) year += 2000;
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (year < 1900 || year > 2200 || !date.ok()) return std::nullopt;
  return static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
}

std::optional<double> seconds_of_day_in(TimeReader& in) {
  const auto hour = in.number(2);
  if (!hour || !in.mark(":")) return std::nullopt;
  const auto minute = in.number(2);
  if (!minute || *minute > 59) return std::nullopt;
  double seconds = 3600.0 * *hour + 60.0 * *minute;
  if (in.mark(":")) {
    const auto whole = in.number(2);
    if (!whole || *whole > 60) return std::nullopt;
    seconds += *whole;
    if (in.mark(".,:")) seconds += in.fraction();
  }
  in.blanks();
  const bool morning = in.word("AM"), evening = !morning && in.word("PM");
  if ((morning && *hour == 12)) seconds -= 43200.0;
  if (evening && *hour < 12) seconds += 43200.0;
  return seconds;
}

// "Z", "+02:00", "-0500"; empty where nothing is stated.
std::optional<double> offset_from_utc(TimeReader& in) {
  in.blanks();
  if (in.at_end() || in.word("Z") || in.word("UTC")) return 0.0;
  const double sign = in.rest().front() == '-' ? -1.0 : 1.0;
  if (!in.mark("+-")) return std::nullopt;
  const auto hours = in.number(2);
  if (!hours) return std::nullopt;
  in.mark(":");
  return sign * (3600.0 * *hours + 60.0 * in.number(2).value_or(0));
}

}  // namespace

std::string_view trimmed_cell(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  return text;
}

void split_csv_cells(std::string_view line, char separator, std::vector<TableCell>& cells) {
  cells.clear();
  std::size_t start = 0;
  bool quoted = false;
  const bool blanks = separator == ' ';
  const auto ends = [&](char c) { return blanks ? c == ' ' || c == '\t' : c == separator; };
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    if (i < line.size() && (quoted || !ends(line[i]))) continue;
    if (!blanks || i > start) cells.push_back({trimmed_cell(line.substr(start, i - start)), start + 1});
    start = i + 1;
  }
}

std::optional<double> number_in_cell(std::string_view text, NumberStyle style) {
  if (style == NumberStyle{}) return plain_number(text);
  constexpr std::string_view kMinus = "\xE2\x88\x92";  // U+2212
  std::string plain;
  bool negative = text.starts_with('-');
  if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
  if (text.starts_with(kMinus)) negative = true, text.remove_prefix(kMinus.size());
  const auto whole_end = std::min({text.find(style.decimal), text.find('e'), text.find('E'), text.size()});
  std::string_view whole = text.substr(0, whole_end);
  if (whole.find(',') != std::string_view::npos || whole.find('.') != std::string_view::npos ||
      (style.thousands != '\0' && whole.find(style.thousands) != std::string_view::npos)) {
    if (style.thousands == '\0' || !has_groups(whole, style.thousands)) return std::nullopt;
  }
  for (const char c : whole)
    if (c != style.thousands) plain.push_back(c);
  for (const char c : text.substr(whole_end)) {
    if (c == style.decimal)
      plain.push_back('.');
    else if (c == '.' || c == ',')
      return std::nullopt;
    else
      plain.push_back(c);
  }
  const auto value = plain_number(plain);
  return value && negative ? std::optional(-*value) : value;
}

bool is_no_sample(std::string_view text) {
  constexpr std::array<std::string_view, 16> kWords{"nan",     "na",     "n/a",   "#n/a",   "#nv", "#value!",
                                                    "#div/0!", "#wert!", "null",  "none",   "-",   "--",
                                                    "---",     "nil",    "#num!", "missing"};
  if (text.empty()) return true;
  if (text.size() > 8) return false;
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return std::find(kWords.begin(), kWords.end(), lower) != kWords.end();
}

std::optional<CellTime> time_in_cell(std::string_view text) {
  if (text.size() < 4 || (!is_digit(text.front()))) return std::nullopt;
  CellTime time;
  TimeReader in(text);
  TimeReader dated(text);
  if (const auto days = days_in(dated)) {
    time.has_date = true;
    time.s = 86400.0 * *days;
    in = dated;
    in.blanks();
    in.mark("T");
    in.blanks();
    if (in.at_end()) return time;
  }
  const auto seconds = seconds_of_day_in(in);
  if (!seconds) return std::nullopt;
  const auto offset = offset_from_utc(in);
  if (!offset || !in.at_end()) return std::nullopt;
  time.s += *seconds - *offset;
  return time;
}

}  // namespace sandhopper
