#include "firmware/log/csv_import.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <istream>
#include <limits>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

namespace sandhopper {
namespace {

constexpr double kEmpty = std::numeric_limits<double>::quiet_NaN();
// Control characters as '?': a terminal obeys them.
std::string printable(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  return out;
}

std::string shown(double value) {
  std::ostringstream text;
  text.precision(9);
  text << value;
  return text.str();
}

class Reading {
 public:
  Reading(std::istream& in, const CsvReadOptions& options)
      : lines_(in, options.format.encoding), options_(options) {}

  CsvTable run() {
    if (!is_text()) return std::move(table_);
    table_.layout = find_layout(lines_.ahead(), lines_.encoding(), options_.format);
    if (!read_header()) return std::move(table_);
    while (next_line())
      if (line_number_ >= table_.layout.first_row_line && !is_remark(line_) && !trimmed_cell(line_).empty())
        read_row();
    note_gaps();
    if (table_.rows() == 0) report({Severity::error, 1, CsvFault::no_rows}, "no rows below the header");
    std::stable_sort(table_.issues.begin(), table_.issues.end(),
                     [](const CsvIssue& a, const CsvIssue& b) { return a.line < b.line; });
    return std::move(table_);
  }

 private:
  using Severity = CsvIssue::Severity;

  bool next_line() {
    if (!lines_.next(line_)) return false;
    ++line_number_;
    return true;
  }

  void split() { split_csv_cells(line_, table_.layout.separator, cells_); }

  bool is_text() {
    const auto binary = binary_format_of(lines_.first_bytes());
    if (!binary) return true;
    report({Severity::error, 1, CsvFault::not_a_text},
           "is " + std::string(binary->name) + ", not a table; " + std::string(binary->cure));
    return false;
  }

  bool read_header() {
    const auto& layout = table_.layout;
    if (layout.is_ambiguous)
      report({Severity::error, 1, CsvFault::ambiguous_number},
             "\"" + layout.ambiguous_cell + "\" may have a decimal comma or one between thousands");
    std::vector<std::string> units;
    const std::uint64_t last = std::max(layout.header_line, layout.units_line);
    std::string header;
    std::uint64_t header_at = 1;
    while (line_number_ < last && next_line()) {
      if (line_number_ == layout.header_line) header = line_, header_at = line_number_;
      if (line_number_ == layout.units_line) units = texts();
    }
    line_ = header;
    if (layout.header_line == 0 && !options_.format.names.empty()) {
      for (const auto& name : options_.format.names) line_ += (line_.empty() ? "" : ",") + name;
      split_csv_cells(line_, ',', cells_);
      line_number_ = 0;
    } else if (layout.header_line == 0 || trimmed_cell(line_).empty()) {
      line_number_ = 1;
      report({Severity::error, 1, CsvFault::no_header},
             "no header: a line above the numbers must name the columns");
      return false;
    } else {
      std::string mark;
      const auto names = without_mark(line_, mark);
      const auto skipped = static_cast<std::uint64_t>(names.data() - line_.data());
      split_csv_cells(names, layout.separator, cells_);
      for (auto& cell : cells_) cell.column += skipped;
    }
    const std::uint64_t behind = std::exchange(line_number_, header_at);
    name_columns(units);
    line_number_ = layout.header_line == 0 ? 0 : behind;
    return true;
  }

  // Texts of the present line's cells.
  std::vector<std::string> texts() {
    std::string mark;
    std::vector<std::string> out;
    split_csv_cells(without_mark(line_, mark), table_.layout.separator, cells_);
    for (const auto& cell : cells_) out.emplace_back(cell.text);
    return out;
  }

  void name_columns(const std::vector<std::string>& units) {
    for (const TableCell& cell : cells_) {
      const bool known = table_.find(cell.text) != nullptr;
      if (known)
        report({Severity::error, cell.column, CsvFault::duplicate_column, cell.text},
               "a second column bears this name");
      const bool used = !known && !cell.text.empty();  // a row index often has no name
      place_of_cell_.push_back(used ? std::optional(table_.names.size()) : std::nullopt);
      if (!used) continue;
      if (cell.text == options_.time_column) time_ = table_.names.size();
      const auto number = static_cast<std::size_t>(&cell - cells_.data());
      table_.names.emplace_back(cell.text);
      table_.columns.emplace_back();
      table_.numbers.push_back(number + 1);
      table_.units.push_back(number < units.size() ? units[number] : "");
    }
    row_.resize(table_.names.size());
    if (!time_ && !options_.time_column.empty())
      report({Severity::error, 1, CsvFault::no_time_column, options_.time_column},
             "no column bears this name, so gaps and order cannot be checked");
  }

  void read_row() {
    split();
    // Some programs end every row with a separator, and not the header.
    if (cells_.size() == place_of_cell_.size() + 1 && cells_.back().text.empty()) cells_.pop_back();
    if (cells_.size() == 1 && place_of_cell_.size() > 1) {
      report({Severity::error, 1, CsvFault::ragged_row},
             "\"" + printable(cells_.front().text.substr(0, 40)) + "\" is no row of " +
                 std::to_string(place_of_cell_.size()) + " cells and is passed over");
      return;
    }
    if (cells_.size() != place_of_cell_.size()) {
      report({Severity::error, line_.size() + 1, CsvFault::ragged_row},
             std::to_string(cells_.size()) + " cells where the header names " +
                 std::to_string(place_of_cell_.size()) + "; row left out");
      return;
    }
    std::uint64_t time_column = 1;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (!place_of_cell_[i]) continue;
      row_[*place_of_cell_[i]] = number(cells_[i], table_.names[*place_of_cell_[i]]);
      if (place_of_cell_[i] == time_) time_column = cells_[i].column;
    }
    if (!time_is_in_order(time_column)) return;
    for (std::size_t i = 0; i < row_.size(); ++i) table_.columns[i].push_back(row_[i]);
    table_.lines.push_back(line_number_);
  }

  double number(const TableCell& cell, const std::string& name) {
    if (is_no_sample(cell.text)) return kEmpty;
    const auto value = number_in_cell(cell.text, table_.layout.numbers);
    if (value && std::isfinite(*value)) return *value;
    if (!value && is_silent(cell.text)) return kEmpty;
    if (const auto* word = value ? nullptr : word_for(cell.text, name)) {
      if (!word->note.empty())
        report({Severity::note, cell.column, CsvFault::word_as_number, name}, std::string(word->note));
      return word->value;
    }
    if (const auto time = value ? std::nullopt : time_in_cell(cell.text)) return seconds(*time);
    const bool is_number = value.has_value();
    report({Severity::error, cell.column, is_number ? CsvFault::not_finite : CsvFault::not_a_number, name},
           "\"" + printable(cell.text) + "\" is not a " + (is_number ? "finite " : "") + "number");
    return kEmpty;
  }

  const CsvWord* word_for(std::string_view text, const std::string& name) const {
    const auto same = [](char a, char b) { return a == b || ((a | 0x20) == (b | 0x20) && (a | 0x20) >= 'a'); };
    for (const auto& word : options_.words)
      if (word.column == name && std::ranges::equal(word.text, text, same)) return &word;
    return nullptr;
  }

  bool is_silent(std::string_view text) const {
    const auto& words = options_.format.no_sample;
    return std::find(words.begin(), words.end(), text) != words.end();
  }

  // A time of day goes on beyond midnight.
  double seconds(const CellTime& time) {
    constexpr double kDay_s = 86400.0;
    if (time.has_date) return time.s;
    if (last_of_day_s_ && time.s + days_s_ < *last_of_day_s_ - 0.5 * kDay_s) days_s_ += kDay_s;
    last_of_day_s_ = time.s + days_s_;
    return *last_of_day_s_;
  }

  bool time_is_in_order(std::uint64_t column) {
    if (!time_) return true;
    const double time_s = row_[*time_];
    const auto& times_s = table_.columns[*time_];
    if (std::isnan(time_s)) {
      report({Severity::error, column, CsvFault::no_time, options_.time_column}, "no time; row left out");
      return false;
    }
    if (times_s.empty() || time_s > times_s.back() || !options_.check_order) return true;
    const std::string times = " from " + shown(times_s.back()) + " to " + shown(time_s) + " s";
    if (time_s < times_s.back()) {
      report({Severity::error, column, CsvFault::time_backwards, options_.time_column},
             "time goes backwards," + times + "; row left out");
      return false;
    }
    report({Severity::note, column, CsvFault::time_stands_still, options_.time_column},
           "time stands still at " + shown(time_s) + " s");
    return true;
  }

  void note_gaps() {
    if (!time_ || table_.rows() < 3) return;
    const auto& times_s = table_.columns[*time_];
    std::vector<double> steps_s(times_s.size() - 1);
    for (std::size_t i = 0; i < steps_s.size(); ++i) steps_s[i] = times_s[i + 1] - times_s[i];
    auto sorted = steps_s;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    if (*middle <= 0.0) return;
    for (std::size_t i = 0; i < steps_s.size(); ++i) {
      if (steps_s[i] <= options_.gap_steps * *middle) continue;
      line_number_ = table_.lines[i + 1];
      report({Severity::note, 1, CsvFault::gap, options_.time_column},
             "a gap of " + shown(steps_s[i]) + " s before this row (median step " + shown(*middle) + " s)");
    }
  }

  struct Place {
    Severity severity;
    std::uint64_t column;
    CsvFault fault;
    std::string_view name{};
  };
  void report(const Place& place, std::string text) {
    const std::uint64_t line = std::max<std::uint64_t>(line_number_, 1);
    if (!options_.list_repeats) {
      const auto first = std::find_if(table_.issues.begin(), table_.issues.end(), [&](const CsvIssue& issue) {
        return issue.fault == place.fault && issue.name == place.name;
      });
      if (first != table_.issues.end()) {
        ++first->repeats;
        first->last_line = line;
        return;
      }
    }
    if (table_.issues.size() >= options_.max_issues) {
      ++table_.more_issues;
      return;
    }
    table_.issues.push_back(
        {place.severity, line, place.column, std::move(text), place.fault, std::string(place.name)});
  }

  TextLines lines_;
  const CsvReadOptions& options_;
  CsvTable table_;
  std::string line_;
  std::uint64_t line_number_ = 0;
  std::vector<TableCell> cells_;
  std::vector<std::optional<std::size_t>> place_of_cell_;  // in the table; none: not used
  std::optional<std::size_t> time_;
  std::vector<double> row_;
  double days_s_ = 0.0;  // midnights passed by times without a date
  std::optional<double> last_of_day_s_{};
};

}  // namespace

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
    case CsvFault::gap:
    case CsvFault::word_as_number:
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

CsvTable read_csv(std::istream& in, const CsvReadOptions& options) { return Reading(in, options).run(); }

std::uint64_t csv_cell_character(const std::filesystem::path& file, std::uint64_t line, std::uint64_t number,
                                 const CsvFormat& format) {
  std::ifstream in(file);
  if (!in) return 1;
  TextLines lines(in, format.encoding);
  const auto layout = find_layout(lines.ahead(), lines.encoding(), format);
  std::string text;
  bool is_there = true;
  for (std::uint64_t i = 1; i <= line && is_there; ++i) is_there = lines.next(text);
  std::string mark;
  const std::string_view cells_text =
      line == layout.header_line ? without_mark(text, mark) : std::string_view(text);
  std::vector<TableCell> cells;
  split_csv_cells(cells_text, layout.separator, cells);
  if (!is_there || number < 1 || number > cells.size()) return 1;
  return cells[number - 1].column + static_cast<std::uint64_t>(cells_text.data() - text.data());
}

CsvTable read_csv(const std::filesystem::path& file, const CsvReadOptions& options) {
  std::ifstream in(file);
  if (!in) throw std::system_error(errno, std::generic_category(), file.string());
  return read_csv(in, options);
}

}  // namespace sandhopper
