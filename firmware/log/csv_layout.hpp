#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "firmware/log/csv_cells.hpp"
#include "firmware/log/csv_text.hpp"

// The way to read the lines of a table: stated by its owner, or found by looking at its first lines.
namespace sandhopper {

// Statements of the owner, [format] of campaign.toml; the rest is found.
struct CsvFormat {
  std::optional<TextEncoding> encoding{};
  std::optional<char> separator{};
  std::optional<char> decimal{};
  std::optional<char> thousands{};             // '\0': none
  std::optional<std::uint64_t> header_line{};  // from 1; 0: the columns have no names but `names`
  std::optional<std::uint64_t> units_line{};   // 0: none
  std::vector<std::string> names{};            // of the columns, where the file has none
  std::vector<std::string> no_sample{};        // further words that say so
  bool spread_times = false;            // rows that share a time came evenly: times with too few digits
  std::optional<bool> day_first{};      // 03/04/2023 is 3 April; false: March 4
  std::optional<bool> minutes_first{};  // 12:30 is 12 min 30 s; false: half past twelve
  double row_every_s = 0.0;  // the file has no time, a row comes every so many seconds; 0: not stated
};

struct CsvLayout {
  TextEncoding encoding = TextEncoding::utf8;
  char separator = ',';
  NumberStyle numbers{};
  std::uint64_t header_line = 1;  // 0: none
  std::uint64_t units_line = 0;   // 0: none
  std::uint64_t first_row_line = 2;
  std::string header_mark{};      // in front of the names: "#"
  char header_separator = ',';    // of the names; nearly always `separator`
  std::size_t row_cells = 0;      // that most rows have
  bool rows_are_counted = false;  // each begins with its number, which has no name (R)
  std::uint64_t misfit_line = 0;  // nearest line above the rows that may name other numbers of columns …
  std::size_t misfit_cells = 0;   // … and its cells; 0: the names were found
  bool has_unused_names = false;  // the last name is that of remarks, and rows end before it (LabVIEW)
  bool is_ambiguous = false;      // 1,234 may be 1234 or 1.234, and nothing in the file tells
  std::string ambiguous_cell{};
  // Unusual things about the file, told to its owner: "its names stand in line 3; lines 1 to 2 are passed
  // over".
  std::vector<std::string> said{};
};

// The table is the longest run of lines with equally many cells, most of them numbers; its names stand in the
// nearest line above with as many cells that are no numbers, units in the line between. A line that states
// `sep=;` is obeyed. Of several ways to divide the lines the one with most numbers counts.
CsvLayout find_layout(const std::deque<std::string>& first_lines, TextEncoding encoding,
                      const CsvFormat& stated);

// Cells of the line of the names. Where blanks divide, "Load (N)" is one name if that gives `wanted` of them.
void split_names(std::string_view line, char separator, std::size_t wanted, std::vector<TableCell>& cells);

// A cell that may be read in two ways where no other cell decides: 1,234 between semicolons, with three
// digits behind every comma; 1.001 beside 3,5. Empty where there is none.
std::string ambiguous_cell_in(const std::deque<std::string>& lines, std::size_t first_row,
                              const CsvLayout& layout);

// A line that holds no cells: blank, or a remark ("#", "%", "//") behind the header.
bool is_remark(std::string_view line);
// The line without the remark's mark and the blanks around it.
std::string_view without_mark(std::string_view line, std::string& mark);
// "m", "[mm]", "(deg)", "N·m", "-": what a row of units holds in a cell.
bool looks_like_unit(std::string_view text);

}  // namespace sandhopper
