#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Parsers for the cells of a table that other programs have written.
namespace sandhopper {

struct TableCell {
  std::string_view text;     // without surrounding blanks and quotes
  std::uint64_t column = 0;  // character of the line, from 1
};

// The separator ' ' means any number of blanks and tabs.
void split_csv_cells(std::string_view line, char separator, std::vector<TableCell>& cells);
std::string_view trimmed_cell(std::string_view text);

// Characters of the number format: 1,234.5 has decimal '.' and thousands ','.
struct NumberStyle {
  char decimal = '.';
  char thousands = '\0';  // none

  bool operator==(const NumberStyle&) const = default;
};
// Empty if the text is no number. A group of thousands has three digits, and no number begins with a group of
// 0. No-break spaces between groups are accepted in every style. Infinity and NaN are numbers. Also accepted:
// a minus of U+2212 or an en dash, Fortran's 1.5D-03, and ="0.5", =0.5, '0.5 and '0.5' of spreadsheets.
std::optional<double> number_in_cell(std::string_view text, NumberStyle style);

// True for a cell without a sample: empty, NaN, nan, -, --.---, N/A, #N/A, #NV, NULL, #####, …
bool is_no_sample(std::string_view text);
// True for a meter's text for a value beyond its range: OL, OVLD, 1.#INF, …
bool is_out_of_range(std::string_view text);
// Infinity of instruments with the SCPI standard. Their NaN is 9.91e37.
inline constexpr double kScpiInfinity = 9.9e37;

// A date or a time of day [s]. If the cell holds a date it counts from 1970-01-01 00:00 UTC, with a stated
// UTC offset removed. Otherwise it counts from midnight.
//   2023-09-13T20:41:18.250Z   2023-09-13 20:41:18+02:00   13.09.2023 20:41:18,25   9/13/2023 8:41:18 PM
//   13-Sep-2023 20:41:18   20:41:18   20:41:18:250   01:02.5 (minutes)   0 days 00:00:01.5
// In 9/13/2023 and 13/9/2023 the number above 12 is the day; if neither is above 12, the first is the month
// unless `day_first`.
struct CellTime {
  double s = 0.0;
  bool has_date = false;
  bool may_be_day_first = false;      // 03/04/2023
  bool has_unclear_fraction = false;  // 20:41:18:5
  bool has_two_parts = false;         // 12:30, read as hours and minutes; it may be minutes and seconds
};
std::optional<CellTime> time_in_cell(std::string_view text, bool day_first = false);

// For messages: printable_cell() shows control characters as '?'; shown_number() prints nine digits.
std::string printable_cell(std::string_view text);
std::string shown_number(double value);

}  // namespace sandhopper
