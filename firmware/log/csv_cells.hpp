#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Cells of a table as other programs write them.
namespace sandhopper {

struct TableCell {
  std::string_view text;     // without blanks and quotes around it
  std::uint64_t column = 0;  // character of the line, from 1
};

// A separator of ' ' stands for any number of blanks and tabs.
void split_csv_cells(std::string_view line, char separator, std::vector<TableCell>& cells);
std::string_view trimmed_cell(std::string_view text);

// The signs with which numbers are written: 1,234.5 has decimal '.' and thousands ','.
struct NumberStyle {
  char decimal = '.';
  char thousands = '\0';  // none

  bool operator==(const NumberStyle&) const = default;
};
// A group of thousands has three digits and no number begins with a group of 0; no-break spaces between
// groups are read whatever the style. Infinity and NaN are numbers here; nothing for a text. So are other
// writers' signs: a minus of U+2212 or an en dash, Fortran's 1.5D-03, ="0.5" and '0.5 of spreadsheets.
std::optional<double> number_in_cell(std::string_view text, NumberStyle style);

// True for a cell that says that there is no sample: empty, NaN, nan, -, --.---, N/A, #N/A, #NV, NULL, #####,
// …
bool is_no_sample(std::string_view text);
// True for a meter's word for a value beyond its range: OL, OVLD, 1.#INF, …
bool is_out_of_range(std::string_view text);
// Infinity and NaN as instruments of the SCPI standard write them: 9.9e37, 9.91e37.
inline constexpr double kScpiInfinity = 9.9e37;

// A date or a time of day, s: since 1970-01-01 00:00 UTC where the cell holds a date (a stated offset from
// UTC is taken off), else since midnight.
//   2023-09-13T20:41:18.250Z   2023-09-13 20:41:18+02:00   13.09.2023 20:41:18,25   9/13/2023 8:41:18 PM
//   13-Sep-2023 20:41:18   20:41:18   20:41:18:250   01:02.5 (minutes)   0 days 00:00:01.5
// In 9/13/2023 and 13/9/2023 the number above 12 is the day; if neither is above 12, the first is the month
// unless `day_first`.
struct CellTime {
  double s = 0.0;
  bool has_date = false;
  bool may_be_day_first = false;      // 03/04/2023
  bool has_unclear_fraction = false;  // 20:41:18:5
  bool has_two_parts = false;         // 12:30, taken as hours and minutes: may be minutes and seconds
};
std::optional<CellTime> time_in_cell(std::string_view text, bool day_first = false);

// For messages: control characters as '?', which a terminal would obey; a number with nine digits.
std::string printable_cell(std::string_view text);
std::string shown_number(double value);

}  // namespace sandhopper
