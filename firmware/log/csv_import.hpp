#pragma once
#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/log/csv_layout.hpp"

namespace sandhopper {

// Faults of a recording.
enum class CsvFault : std::uint8_t {
  no_header,
  no_rows,
  no_time_column,
  duplicate_column,
  ragged_row,
  not_a_number,
  not_finite,
  no_time,
  time_backwards,
  time_stands_still,
  gap,
  not_a_text,
  ambiguous_number,
  word_as_number,
  date_in_channel,     // a date or time instead of a number
  ambiguous_time,      // 12:30, 03/04/2023
  out_of_range,        // a meter's OL or its 9.9e37
  counter_wrapped,     // a counter of 32 bits overflowed
  several_recordings,  // one below the other: the time starts again
  cut_row,             // the file ends within its last cell
  names_do_not_fit     // there are more or fewer names than cells in a row
};

// Remedy for the owner of the recording; empty if nothing is lost.
std::string_view cure_for(CsvFault fault);

// A message about the recording for its reader, with the place in the file.
struct CsvIssue {
  enum class Severity : std::uint8_t {
    note,  // the recording can be used as it is: a gap, a repeated time
    error  // a value or row had to be left out
  };
  Severity severity = Severity::error;
  std::uint64_t line = 0;    // from 1; the header is line 1
  std::uint64_t column = 0;  // character in the line, from 1
  std::string text;
  CsvFault fault = CsvFault::no_header;
  std::string name{};           // name of the column, if the fault concerns one column
  std::uint64_t repeats = 0;    // number of further equal faults in this column, which are not listed
  std::uint64_t last_line = 0;  // line of the last of them
};

// "file:line:column: name: text; cure"
std::string describe(std::string_view file, const CsvIssue& issue);

struct CsvTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;  // as names; NaN: no sample
  std::vector<std::uint64_t> numbers;        // index as in `names`: number of the column in the file, from 1
  std::vector<std::uint64_t> lines;          // for each row its line in the file
  std::vector<CsvIssue> issues;              // in the order of the file, at most CsvReadOptions::max_issues
  std::uint64_t more_issues = 0;             // number of issues beyond that limit
  std::vector<std::string> units{};          // index as in `names`: cell of the row of units, or empty
  std::vector<std::string> clocks{};         // columns whose cells are dates or times of day; their unit is s
  CsvLayout layout{};

  std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
  const std::vector<double>* find(std::string_view name) const;  // null if there is none
  bool has_errors() const;
};

// A text that stands for a number in the cells of one column. Case is ignored.
struct CsvWord {
  std::string column;
  std::string_view text;
  double value;             // NaN: no sample
  std::string_view note{};  // reported once if the word occurs
};

struct CsvReadOptions {
  std::string time_column = "t_s";  // empty: rows have no time
  double gap_steps = 5.0;           // a step longer than this many median steps is a gap
  std::size_t max_issues = 50;
  bool check_order = true;   // false: rows may step back in time
  bool list_repeats = true;  // false: repeats of a fault in a column are counted, not listed
  CsvFormat format{};        // known properties of the file
  std::vector<CsvWord> words{};
  std::string second_time_column{};  // second part of the time, such as a time of day beside a date
  std::uint64_t first_line = 0, last_line = UINT64_MAX;  // rows outside are not read
};

// Reads a recording: a header of unique names, then rows of numbers. An empty cell or NaN, -, #N/A means no
// sample. A date or time of day is read as seconds (csv_cells.hpp). Encoding, separator, decimal comma, lines
// above the header and a row of units are detected (csv_layout.hpp) unless `format` states them. Remarks
// between rows and an empty cell at every row's end are skipped. Faults are listed with their place and left
// out; the rest is read. A cell that is not a finite number becomes empty. A row with a missing or extra
// cell, without a time, or with a time that goes backwards is dropped. A second column of the same name is an
// error and ignored. Dates and times of day are numbers only in the time columns; without a `time_column`
// they are in all columns.
CsvTable read_csv(std::istream& in, const CsvReadOptions& options = {});
// Character, from 1, at which cell `number` of a line begins; 1 if there is no such cell.
std::uint64_t csv_cell_character(const std::filesystem::path& file, std::uint64_t line, std::uint64_t number,
                                 const CsvFormat& format = {});
// Throws std::system_error if the file cannot be opened.
CsvTable read_csv(const std::filesystem::path& file, const CsvReadOptions& options = {});

// Median step of the time from row to row; needs two rows.
double median_step_s(const std::vector<double>& t_s);

}  // namespace sandhopper
