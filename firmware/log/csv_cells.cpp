#include "firmware/log/csv_cells.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <sstream>

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

// True for "1,234,567": one to three digits, not beginning with 0, then groups of three.
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

// True for "12,34,567", as numbers are grouped in India: groups of two, and three digits at the end. It takes
// two commas to tell.
bool has_indian_groups(std::string_view whole) {
  std::size_t digits = 0, marks = 0;
  for (auto at = whole.rbegin(); at != whole.rend(); ++at) {
    const bool is_mark = digits == (marks == 0 ? 3 : 2) && *at == ',';
    if (!is_mark && !is_digit(*at)) return false;
    marks += is_mark;
    digits = is_mark ? 0 : digits + 1;
    if (digits > 3 || (marks > 0 && digits > 2)) return false;
  }
  return marks > 1 && digits > 0 && whole.front() != '0';
}

// Group separator that no locale uses as a decimal mark: no-break, narrow and thin spaces become this byte.
constexpr char kGroup = '\x01';

// A sign or digit of full width, '+' (U+FF0B) to '9' (U+FF19), as the plain one; '\0' for another character.
char from_full_width(std::string_view text) {
  if (text.size() < 3 || text[0] != '\xEF' || text[1] != '\xBC') return '\0';
  const int third = static_cast<unsigned char>(text[2]);
  return third >= 0x8B && third <= 0x99 ? static_cast<char>('+' + third - 0x8B) : '\0';
}

// Replaces minus signs, digits of full width, apostrophes and spaces beyond ASCII by the usual characters and
// Fortran's exponent (1.5D-03) by E. Removes the quoting by which a spreadsheet keeps a number as text
// (="0.5", =0.5, '0.5, '0.5').
std::string plainly_written(std::string_view text) {
  struct Sign {
    std::string_view written;
    char plain;
  };
  constexpr std::array<Sign, 6> kSigns{{{"\xE2\x88\x92", '-'},
                                        {"\xE2\x80\x93", '-'},
                                        {"\xE2\x80\x99", '\''},
                                        {"\xC2\xA0", kGroup},
                                        {"\xE2\x80\xAF", kGroup},
                                        {"\xE2\x80\x89", kGroup}}};
  if (text.starts_with('=')) text = trimmed_cell(text.substr(1));
  if (text.size() > 2 && text.starts_with('\'') && text.ends_with('\'')) text.remove_suffix(1);
  if (text.starts_with('\'')) text.remove_prefix(1);
  std::string out;
  while (!text.empty()) {
    const auto* sign = std::find_if(kSigns.begin(), kSigns.end(),
                                    [&](const Sign& s) { return text.starts_with(s.written); });
    if (sign != kSigns.end()) {
      out.push_back(sign->plain);
      text.remove_prefix(sign->written.size());
      continue;
    }
    if (const char plain = from_full_width(text); plain != '\0') {
      out.push_back(plain);
      text.remove_prefix(3);
      continue;
    }
    const bool is_exponent = (text.front() == 'D' || text.front() == 'd') && !out.empty() &&
                             (is_digit(out.back()) || out.back() == '.') && text.size() > 1 &&
                             (is_digit(text[1]) || text[1] == '-' || text[1] == '+');
    out.push_back(is_exponent ? 'E' : text.front());
    text.remove_prefix(1);
  }
  return out;
}

bool needs_rewriting(std::string_view text) {
  return text.starts_with('=') || text.starts_with('\'') || std::any_of(text.begin(), text.end(), [](char c) {
           return (c & 0x80) != 0 || c == 'D' || c == 'd';
         });
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

// Number of the month, e.g. 9 for "Sep" in 13-Sep-2023.
std::optional<int> month_named_in(TimeReader& in) {
  constexpr std::array<std::string_view, 12> kMonths{"JAN", "FEB", "MAR", "APR", "MAY", "JUN",
                                                     "JUL", "AUG", "SEP", "OCT", "NOV", "DEC"};
  for (std::size_t i = 0; i < kMonths.size(); ++i)
    if (in.word(kMonths[i])) return static_cast<int>(i) + 1;
  return std::nullopt;
}

struct Days {
  double since_1970 = 0.0;
  bool is_ambiguous = false;  // 03/04/2023: both numbers may be the month
};

std::optional<Days> days_in(TimeReader& in, bool day_first) {
  const auto first = in.number(4);
  if (!first) return std::nullopt;
  const char mark = in.rest().empty() ? '\0' : in.rest().front();
  if (!in.mark("-/. ")) return std::nullopt;
  const auto named = month_named_in(in);
  const auto second = named ? named : in.number(2);
  if (!second || in.rest().empty() || in.rest().front() != mark || !in.mark("-/.")) return std::nullopt;
  const auto third = in.number(4);
  if (!third) return std::nullopt;
  if (mark == ' ' && !named) return std::nullopt;
  int year = *third, month = *first, day = *second;
  const bool ambiguous = mark == '/' && !named && *first <= 12 && *second <= 12;
  if (*first > 31) {
    year = *first, month = *second, day = *third;
  } else if (named || mark != '/' || *first > 12 || day_first) {
    day = *first, month = *second;
  }
  if (year < 100) year += 2000;
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (year < 1900 || year > 2200 || !date.ok()) return std::nullopt;
  return Days{static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count()), ambiguous};
}

// After a colon come whole ms, us or ns (3, 6 or 9 digits). Other lengths are unclear: 18:5 may be 5 ms or
// half a second.
struct Fraction {
  double s = 0.0;
  bool is_unclear = false;
};
Fraction fraction_in(TimeReader& in) {
  const bool by_colon = in.mark(":");
  if (!by_colon && !in.mark(".,")) return {};
  const auto before = in.rest().size();
  const double value = in.fraction();
  const auto digits = before - in.rest().size();
  return {value, by_colon && digits % 3 != 0};
}

struct TimeOfDay {
  double s = 0.0;
  bool has_two_parts = false;
  bool has_unclear_fraction = false;
};

std::optional<TimeOfDay> time_of_day_in(TimeReader& in) {
  const auto hour = in.number(3);
  if (!hour || !in.mark(":")) return std::nullopt;
  const auto minute = in.number(2);
  if (!minute || *minute > 59) return std::nullopt;
  double seconds = 3600.0 * *hour + 60.0 * *minute;
  const bool two_parts = in.rest().empty() || in.rest().front() != ':';
  if (two_parts && !in.rest().empty() && (in.rest().front() == '.' || in.rest().front() == ',')) {
    return TimeOfDay{seconds / 60.0 + fraction_in(in).s};  // 01:02.5: minutes and seconds
  }
  bool unclear = false;
  if (in.mark(":")) {
    const auto whole = in.number(2);
    if (!whole || *whole > 60) return std::nullopt;
    const auto fraction = fraction_in(in);
    seconds += *whole + fraction.s;
    unclear = fraction.is_unclear;
  }
  in.blanks();
  const bool morning = in.word("AM"), evening = !morning && in.word("PM");
  if ((morning && *hour == 12)) seconds -= 43200.0;
  if (evening && *hour < 12) seconds += 43200.0;
  return TimeOfDay{seconds, two_parts && !morning && !evening, unclear};
}

// Reads "Z", "+02:00" or "-0500" [s]; empty if no offset is stated.
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

// In "1.007,59" the first sign can only divide thousands, also where the rows looked at to find the style
// hold no number above 1000.
NumberStyle with_clear_thousands(std::string_view text, NumberStyle style) {
  const char other = style.decimal == ',' ? '.' : ',';
  const auto at = text.find(style.decimal);
  const bool is_clear = at != std::string_view::npos && text.find(other) < at &&
                        text.find(style.decimal, at + 1) == std::string_view::npos;
  return style.thousands == '\0' && is_clear ? NumberStyle{style.decimal, other} : style;
}

// A minus behind the number (0.16-) and Indian groups (12,34,567.8) have no other meaning, so they are read.
std::optional<double> number_in_cell(std::string_view text, NumberStyle style) {
  style = with_clear_thousands(text, style);
  if (style == NumberStyle{})
    if (const auto value = plain_number(text)) return value;
  std::string rewritten, plain;
  if (needs_rewriting(text)) {
    rewritten = plainly_written(text);
    const std::string_view digits = std::string_view(rewritten).substr(rewritten.starts_with('-'));
    const bool grouped = rewritten.find(kGroup) != std::string::npos;
    if (grouped && !has_groups(digits.substr(0, digits.find(style.decimal)), kGroup)) return std::nullopt;
    std::erase(rewritten, kGroup);
    text = rewritten;
  }
  // The minus follows a digit: "5,-" is a price without cents.
  const bool has_minus_behind =
      text.size() > 1 && text.ends_with('-') && is_digit(text.front()) && is_digit(text[text.size() - 2]);
  if (has_minus_behind) text.remove_suffix(1);
  const bool negative = text.starts_with('-') || has_minus_behind;
  if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
  if (text.starts_with('-') || text.starts_with('+')) return std::nullopt;
  const auto whole_end = std::min({text.find(style.decimal), text.find('e'), text.find('E'), text.size()});
  std::string_view whole = text.substr(0, whole_end);
  const bool has_marks = whole.find_first_of(",.") != std::string_view::npos ||
                         (style.thousands != '\0' && whole.find(style.thousands) != std::string_view::npos);
  if (has_marks && style.decimal == '.' && has_indian_groups(whole))
    style.thousands = ',';
  else if (has_marks && (style.thousands == '\0' || !has_groups(whole, style.thousands)))
    return std::nullopt;
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
  // The last words are those of Microsoft's C library for NaN.
  constexpr std::array<std::string_view, 22> kWords{
      "nan",     "na",     "n/a",     "#n/a",     "#nv",       "#value!", "#div/0!", "#wert!",
      "null",    "none",   "nil",     "#num!",    "#ref!",     "missing", "invalid", "-nan",
      "1.#qnan", "1.#ind", "-1.#ind", "nan(ind)", "-nan(ind)", "1.#snan"};
  if (text.empty()) return true;
  // "-", "--.---", ".": a display without a value; "#####": a spreadsheet column that is too narrow.
  if (text.find_first_not_of("-.") == std::string_view::npos ||
      text.find_first_not_of('#') == std::string_view::npos)
    return true;
  if (text.size() > 9) return false;
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return std::find(kWords.begin(), kWords.end(), lower) != kWords.end();
}

bool is_out_of_range(std::string_view text) {
  constexpr std::array<std::string_view, 12> kWords{"ol",   "+ol",   "-ol", "ovl",      "ovld",   "ovfl",
                                                    "over", "ovrng", "ofl", "overload", "1.#inf", "-1.#inf"};
  if (text.size() > 8 || text.size() < 2) return false;
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return std::find(kWords.begin(), kWords.end(), lower) != kWords.end();
}

std::optional<CellTime> time_in_cell(std::string_view text, bool day_first) {
  if (text.size() < 4 || (!is_digit(text.front()))) return std::nullopt;
  CellTime time;
  TimeReader in(text);
  TimeReader dated(text), counted(text);
  const auto count = counted.number(4);  // "0 days 00:00:01.5"
  counted.blanks();
  if (count && (counted.word("DAYS") || counted.word("DAY"))) {
    time.s = 86400.0 * *count;
    in = counted;
    in.blanks();
  } else if (const auto days = days_in(dated, day_first)) {
    time.has_date = true;
    time.may_be_day_first = days->is_ambiguous;
    time.s = 86400.0 * days->since_1970;
    in = dated;
    in.blanks();
    in.mark("T");
    in.blanks();
    if (in.at_end()) return time;
  }
  const auto of_day = time_of_day_in(in);
  if (!of_day) return std::nullopt;
  const auto offset = offset_from_utc(in);
  if (!offset || !in.at_end()) return std::nullopt;
  time.s += of_day->s - *offset;
  time.has_two_parts = of_day->has_two_parts && !time.has_date;
  time.has_unclear_fraction = of_day->has_unclear_fraction;
  return time;
}

// Shows control characters as '?', because a terminal would execute them.
std::string printable_cell(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  return out;
}

std::string shown_number(double value) {
  std::ostringstream text;
  text.precision(9);
  text << value;
  return text.str();
}

}  // namespace sandhopper
