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
// A group of thousands has three digits and no number begins with a group of 0. Infinity and NaN are numbers
// here; nothing for a text.
std::optional<double> number_in_cell(std::string_view text, NumberStyle style);

// True for a cell that says that there is no sample: empty, NaN, nan, -, --, N/A, #N/A, #NV, NULL, None, …
bool is_no_sample(std::string_view text);

// A date or a time of day, s: since 1970-01-01 00:00 UTC where the cell holds a date (a stated offset from
// UTC is taken off), else since midnight.
//   2023-09-13T20:41:18.250Z   2023-09-13 20:41:18+02:00   13.09.2023 20:41:18,25   9/13/2023 8:41:18 PM
//   20:41:18
// In 9/13/2023 and 13/9/2023 the number above 12 is the day; if neither is above 12, the first is the month.
struct CellTime {
  double s = 0.0;
  bool has_date = false;
};
std::optional<CellTime> time_in_cell(std::string_view text);

}  // namespace sandhopper
