#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "firmware/log/csv_cells.hpp"
#include "firmware/log/csv_text.hpp"

// Layout of a table: stated by its owner, or detected from its first lines.
namespace sandhopper {

// Statements of the owner in [format] of campaign.toml. The rest is detected.
struct CsvFormat {
  std::optional<TextEncoding> encoding{};
  std::optional<char> separator{};
  std::optional<char> decimal{};
  std::optional<char> thousands{};             // '\0': none
  std::optional<std::uint64_t> header_line{};  // from 1; 0: the file has no names, see `names`
  std::optional<std::uint64_t> units_line{};   // 0: none
  std::vector<std::string> names{};            // names of the columns if the file has none
  std::vector<std::string> no_sample{};        // further words that mean "no sample"
  bool spread_times = false;            // rows with the same time are spread evenly: the times have too few
                                        // digits
  std::optional<bool> day_first{};      // 03/04/2023 is 3 April; false: March 4
  std::optional<bool> minutes_first{};  // 12:30 is 12 min 30 s; false: half past twelve
  double frames_per_s = 0.0;            // 10:00:00:12 is frame 12 of so many in a second; 0: not stated
  double time_restarts_at = 0.0;  // the time column begins again at 0 there, in its own unit: 60 for the
                                  // seconds of a minute; 0: it does not
  double row_every_s = 0.0;       // period of the rows if the file has no time [s]; 0: not stated
};

struct CsvLayout {
  TextEncoding encoding = TextEncoding::utf8;
  char separator = ',';
  NumberStyle numbers{};
  std::uint64_t header_line = 1;  // 0: none
  std::uint64_t units_line = 0;   // 0: none
  std::uint64_t first_row_line = 2;
  std::string header_mark{};      // mark before the names, such as "#"
  char header_separator = ',';    // separator of the names; nearly always `separator`
  std::size_t row_cells = 0;      // number of cells that most rows have
  bool rows_are_counted = false;  // each row begins with its number, which has no name (R)
  std::uint64_t misfit_line = 0;  // nearest line above the rows that may hold the names, but with another
                                  // number of cells
  std::size_t misfit_cells = 0;   // number of its cells; 0: the names were found
  bool has_unused_names = false;  // the last name is that of a remarks column, which the rows lack (LabVIEW)
  bool is_ambiguous = false;      // 1,234 may be 1234 or 1.234, and nothing in the file decides
  std::string ambiguous_cell{};
  // Messages to the owner about unusual properties: "its names stand in line 3; lines 1 to 2 are passed
  // over".
  std::vector<std::string> said{};
};

// Number of lines to read in advance, so that a stated line of names in mid-file is among them.
std::size_t lines_ahead(const CsvFormat& stated);

// The table is the longest run of lines with equally many cells, most of them numbers. Its names are in the
// nearest line above with as many cells that are no numbers; units may be in the line between. A line `sep=;`
// sets the separator. Of several possible separators the one that gives most numbers is used.
CsvLayout find_layout(const std::deque<std::string>& first_lines, TextEncoding encoding,
                      const CsvFormat& stated);

// Cells of the line of names. If blanks separate, "Load (N)" is one name if that gives `wanted` names.
void split_names(std::string_view line, char separator, std::size_t wanted, std::vector<TableCell>& cells);

// A cell that can be read in two ways if no other cell decides: 1,234 between semicolons with three digits
// after every comma, or 1.001 beside 3,5. Empty if there is none.
std::string ambiguous_cell_in(const std::deque<std::string>& lines, std::size_t first_row,
                              const CsvLayout& layout);

// Messages about an encoding other than UTF-8, and about words that show another one.
std::vector<std::string> encoding_in_words(TextEncoding encoding, const std::deque<std::string>& lines);

// For a table without a line of names in which each line begins with a name and goes on with numbers: a
// message that the channels are rows, and its cure. Empty for another table.
std::string cure_for_transposed(const std::deque<std::string>& lines, const CsvLayout& layout);

// True for a line without cells: blank, or a remark ("#", "%", "//") after the header.
bool is_remark(std::string_view line);
// The line without the remark's mark and the blanks around it.
std::string_view without_mark(std::string_view line, std::string& mark);
// True for the content of a unit cell: "m", "[mm]", "(deg)", "N·m", "-".
bool looks_like_unit(std::string_view text);

}  // namespace sandhopper
