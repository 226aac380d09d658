#include <algorithm>
#include <cerrno>
#include <fstream>
#include <system_error>

#include "firmware/log/csv_import.hpp"

// Texts of a table's faults, the look-up functions of CsvTable, and reading by the file's name.
namespace sandhopper {

std::string_view cure_for(CsvFault fault) {
  switch (fault) {
    case CsvFault::no_header:
      return "write the columns' names in the first line: t_s,…";
    case CsvFault::no_rows:
      return "record the trial again or leave it out";
    case CsvFault::no_time_column:
      return "name the column of the time";
    case CsvFault::duplicate_column:
      return "rename one of them";
    case CsvFault::ragged_row:
      return "give every row as many cells as the header";
    case CsvFault::not_a_number:
    case CsvFault::not_finite:
      return "leave the cell empty where there is no sample";
    case CsvFault::no_time:
      return "give every row its time";
    case CsvFault::time_backwards:
      return "sort the rows, or record with a clock that is not set back";
    case CsvFault::time_stands_still:
      return "give every row a time of its own";
    case CsvFault::date_in_channel:
      return "format the column as numbers before saving, or leave it out";
    case CsvFault::ambiguous_time:
      return "say which: [format] frames_per_s = 25 for so many in a second, clock = \"mm:ss\" or \"hh:mm\", "
             "or day_first = true or false, in campaign.toml";
    case CsvFault::several_recordings:
      return "give each recording a [[trial]] with its lines, select = { from_line = 2, to_line = 41 }; a "
             "table "
             "that stands upside down must be sorted by time";
    case CsvFault::names_do_not_fit:
      return "name every column once; a name that holds a separator stands in quotes; or [format] "
             "header_line = 0 "
             "and names = […]";
    case CsvFault::gap:
    case CsvFault::word_as_number:
    case CsvFault::out_of_range:
    case CsvFault::counter_wrapped:
    case CsvFault::cut_row:
    case CsvFault::not_a_text:
      return "";
    case CsvFault::ambiguous_number:
      return "say which: [format] decimal = \",\" or thousands = \",\" in campaign.toml";
  }
  return "";
}

std::string describe(std::string_view file, const CsvIssue& issue) {
  std::string text(file);
  text += ':' + std::to_string(issue.line) + ':' + std::to_string(issue.column) + ": ";
  if (!issue.name.empty()) text += issue.name + ": ";
  text += issue.text;
  if (const auto cure = cure_for(issue.fault); !cure.empty()) text.append("; ").append(cure);
  return text;
}

const std::vector<double>* CsvTable::find(std::string_view name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? nullptr : &columns[static_cast<std::size_t>(found - names.begin())];
}

bool CsvTable::has_errors() const {
  return std::any_of(issues.begin(), issues.end(),
                     [](const CsvIssue& issue) { return issue.severity == CsvIssue::Severity::error; });
}

std::uint64_t csv_cell_character(const std::filesystem::path& file, std::uint64_t line, std::uint64_t number,
                                 const CsvFormat& format) {
  std::ifstream in(file);
  if (!in) return 1;
  TextLines lines(in, format.encoding, lines_ahead(format));
  const auto layout = find_layout(lines.ahead(), lines.encoding(), format);
  std::string text;
  bool is_there = true;
  for (std::uint64_t i = 1; i <= line && is_there; ++i) is_there = lines.next(text);
  std::string mark;
  const std::string_view cells_text =
      line == layout.header_line ? without_mark(text, mark) : std::string_view(text);
  std::vector<TableCell> cells;
  if (line == layout.header_line)
    split_names(cells_text, layout.header_separator, layout.row_cells, cells);
  else
    split_csv_cells(cells_text, layout.separator, cells);
  if (!is_there || number < 1 || number > cells.size()) return 1;
  return cells[number - 1].column + static_cast<std::uint64_t>(cells_text.data() - text.data());
}

double median_step_s(const std::vector<double>& t_s) {
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < t_s.size(); ++i) steps_s.push_back(t_s[i] - t_s[i - 1]);
  const auto middle = steps_s.begin() + static_cast<std::ptrdiff_t>(steps_s.size() / 2);
  std::nth_element(steps_s.begin(), middle, steps_s.end());
  return *middle;
}

CsvTable read_csv(const std::filesystem::path& file, const CsvReadOptions& options) {
  std::ifstream in(file);
  if (!in) throw std::system_error(errno, std::generic_category(), file.string());
  return read_csv(in, options);
}

}  // namespace sandhopper
