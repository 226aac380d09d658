#pragma once
#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/log/csv_layout.hpp"

namespace sandhopper {

// What can be wrong with a recording.
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
  date_in_channel,     // a date or time where a number is due
  ambiguous_time,      // 12:30, 03/04/2023
  out_of_range,        // a meter's OL, or its 9.9e37
  counter_wrapped,     // of 32 bits
  several_recordings,  // one below the other: the time begins again
  cut_row,             // the file ends within its last cell
  names_do_not_fit     // the names are more or fewer than the cells of a row
};

// What the recording's owner can do about it; empty where nothing is lost.
std::string_view cure_for(CsvFault fault);

// Something the reader of a recording should know, at its place in the file.
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
  std::string name{};           // the column's name, where one column is meant
  std::uint64_t repeats = 0;    // the same fault in the same column again, and not listed …
  std::uint64_t last_line = 0;  // … for the last time here
};

// "file:line:column: name: text; cure"
std::string describe(std::string_view file, const CsvIssue& issue);

struct CsvTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;  // as names; NaN: no sample
  std::vector<std::uint64_t> numbers;        // as names: number of the column in the file, from 1
  std::vector<std::uint64_t> lines;          // of the file, for each row
  std::vector<CsvIssue> issues;       // in the order of the file, at most CsvReadOptions::max_issues …
  std::uint64_t more_issues = 0;      // … and this many besides
  std::vector<std::string> units{};   // as names: the cell of the row of units, empty without one
  std::vector<std::string> clocks{};  // columns whose cells are dates or times of day: in s
  CsvLayout layout{};

  std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
  const std::vector<double>* find(std::string_view name) const;  // null when there is none
  bool has_errors() const;
};

// A text that stands for a number in the cells of one column; upper and lower case are the same.
struct CsvWord {
  std::string column;
  std::string_view text;
  double value;             // NaN: no sample
  std::string_view note{};  // told once where the word is used
};

struct CsvReadOptions {
  std::string time_column = "t_s";  // empty: rows have no time
  double gap_steps = 5.0;           // a step longer than this many median steps is a gap
  std::size_t max_issues = 50;
  bool check_order = true;   // false: rows may step back in time
  bool list_repeats = true;  // false: the same fault in the same column is listed once and then counted
  CsvFormat format{};        // what is known of the file
  std::vector<CsvWord> words{};
  std::string second_time_column{};  // holds a part of the time: a time of day beside a date
  std::uint64_t first_line = 0, last_line = UINT64_MAX;  // rows outside are not read
};

// Reads a recording: a header of unique names, then numbers; a cell that is empty or says NaN, -, #N/A is no
// sample; a date or time of day is read as seconds (csv_cells.hpp). Encoding, separator, decimal comma, lines
// above the header and a row of units are found (csv_layout.hpp) where `format` does not state them; remarks
// between rows are passed over, and so is an empty cell at every row's end. What is wrong is listed with its
// place and left out, the rest is read: a cell that is not a number (infinity included) becomes an empty one;
// a row with a missing or extra cell, without a time, or whose time goes backwards is dropped. A second
// column of the same name is an error and ignored. A date or time of day is a number in the columns of the
// time alone; with no `time_column` in all.
CsvTable read_csv(std::istream& in, const CsvReadOptions& options = {});
// Character, from 1, at which cell `number` of a line begins; 1 where there is no such cell.
std::uint64_t csv_cell_character(const std::filesystem::path& file, std::uint64_t line, std::uint64_t number,
                                 const CsvFormat& format = {});
// Throws std::system_error when the file cannot be opened.
CsvTable read_csv(const std::filesystem::path& file, const CsvReadOptions& options = {});

}  // namespace sandhopper
