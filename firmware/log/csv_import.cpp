#include "firmware/log/csv_import.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <fstream>
#include <istream>
#include <limits>
#include <optional>
#include <sstream>
#include <system_error>

namespace sandhopper {
namespace {

constexpr double kEmpty = std::numeric_limits<double>::quiet_NaN();
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

struct Cell {
  std::string_view text;
  std::uint64_t column = 0;
};

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  return text;
}

std::string shown(double value) {
  std::ostringstream text;
  text.precision(9);
  text << value;
  return text.str();
}

char separator_of(std::string_view header) {
  for (const char separator : {',', ';', '\t'})
    if (header.find(separator) != std::string_view::npos) return separator;
  return ',';
}

// The line's cells without the blanks and quotes around them.
void split_cells(std::string_view line, char separator, std::vector<Cell>& cells) {
  cells.clear();
  std::size_t start = 0;
  bool quoted = false;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    if (i < line.size() && (quoted || line[i] != separator)) continue;
    cells.push_back({trimmed(line.substr(start, i - start)), start + 1});
    start = i + 1;
  }
}

class Reading {
 public:
  Reading(std::istream& in, const CsvReadOptions& options) : in_(in), options_(options) {}

  CsvTable run() {
    if (!next_line() || trimmed(line_).empty()) {
      report({Severity::error, 1, CsvFault::no_header}, "no header: the first line must name the columns");
      return std::move(table_);
    }
    if (!read_header()) return std::move(table_);
    while (next_line())
      if (!trimmed(line_).empty()) read_row();
    note_gaps();
    if (table_.rows() == 0) report({Severity::error, 1, CsvFault::no_rows}, "no rows below the header");
    std::stable_sort(table_.issues.begin(), table_.issues.end(),
                     [](const CsvIssue& a, const CsvIssue& b) { return a.line < b.line; });
    return std::move(table_);
  }

 private:
  using Severity = CsvIssue::Severity;

  bool next_line() {
    if (!std::getline(in_, line_)) return false;
    ++line_number_;
    if (line_number_ == 1 && line_.starts_with(kByteOrderMark)) line_.erase(0, kByteOrderMark.size());
    if (line_.ends_with('\r')) line_.pop_back();
    return true;
  }

  void split() { split_cells(line_, separator_, cells_); }

  bool read_header() {
    separator_ = separator_of(line_);
    split();
    if (std::all_of(cells_.begin(), cells_.end(), [](const Cell& cell) { return parsed(cell.text); })) {
      report({Severity::error, 1, CsvFault::no_header},
             "no header: the first line holds numbers where it must name the columns");
      return false;
    }
    for (const Cell& cell : cells_) {
      const bool known = table_.find(cell.text) != nullptr;
      if (known)
        report({Severity::error, cell.column, CsvFault::duplicate_column, cell.text},
               "a second column bears this name");
      const bool used = !known && !cell.text.empty();  // a row index often has no name
      place_of_cell_.push_back(used ? std::optional(table_.names.size()) : std::nullopt);
      if (!used) continue;
      if (cell.text == options_.time_column) time_ = table_.names.size();
      table_.names.emplace_back(cell.text);
      table_.columns.emplace_back();
      table_.numbers.push_back(static_cast<std::uint64_t>(&cell - cells_.data()) + 1);
    }
    row_.resize(table_.names.size());
    if (!time_ && !options_.time_column.empty())
      report({Severity::error, 1, CsvFault::no_time_column, options_.time_column},
             "no column bears this name, so gaps and order cannot be checked");
    return true;
  }

  void read_row() {
    split();
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

  static std::optional<double> parsed(std::string_view digits) {
    if (digits.starts_with('+')) digits.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
    return value;
  }

  double number(const Cell& cell, const std::string& name) {
    if (cell.text.empty()) return kEmpty;
    const auto value = parsed(cell.text);
    if (value && std::isfinite(*value)) return *value;
    const bool is_number = value.has_value();
    report({Severity::error, cell.column, is_number ? CsvFault::not_finite : CsvFault::not_a_number, name},
           "\"" + std::string(cell.text) + "\" is not a " + (is_number ? "finite " : "") + "number");
    return kEmpty;
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

  std::istream& in_;
  const CsvReadOptions& options_;
  CsvTable table_;
  std::string line_;
  std::uint64_t line_number_ = 0;
  char separator_ = ',';
  std::vector<Cell> cells_;
  std::vector<std::optional<std::size_t>> place_of_cell_;  // in the table; none: not used
  std::optional<std::size_t> time_;
  std::vector<double> row_;
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
      return "";
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

std::uint64_t csv_cell_character(const std::filesystem::path& file, std::uint64_t line,
                                 std::uint64_t number) {
  std::ifstream in(file);
  std::string text;
  char separator = ',';
  for (std::uint64_t i = 1; i <= line && std::getline(in, text); ++i)
    if (i == 1) separator = separator_of(text);
  std::vector<Cell> cells;
  split_cells(text, separator, cells);
  return in && number >= 1 && number <= cells.size() ? cells[number - 1].column : 1;
}

CsvTable read_csv(const std::filesystem::path& file, const CsvReadOptions& options) {
  std::ifstream in(file);
  if (!in) throw std::system_error(errno, std::generic_category(), file.string());
  return read_csv(in, options);
}

}  // namespace sandhopper
