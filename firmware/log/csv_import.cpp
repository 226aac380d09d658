#include "firmware/log/csv_import.hpp"

#include <algorithm>
#include <cmath>
#include <istream>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>

#include "firmware/log/csv_row_times.hpp"
#include "firmware/log/csv_time_code.hpp"

namespace sandhopper {
namespace {

constexpr double kEmpty = std::numeric_limits<double>::quiet_NaN();
class Reading {
 public:
  Reading(std::istream& in, const CsvReadOptions& options)
      : lines_(in, options.format.encoding, lines_ahead(options.format)), options_(options) {}

  CsvTable run() {
    if (!is_text()) return std::move(table_);
    table_.layout = find_layout(lines_.ahead(), lines_.encoding(), options_.format);
    if (!read_header()) return std::move(table_);
    while (next_line())
      if (is_wanted() && !is_remark(line_) && !trimmed_cell(line_).empty()) read_row();
    leave_out_cut_row();
    explain_back_steps();
    check_frames();
    note_gaps();
    if (table_.rows() == 0) report_no_rows();
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

  bool is_wanted() const {
    return line_number_ >= std::max(table_.layout.first_row_line, options_.first_line) &&
           line_number_ <= options_.last_line;
  }

  void split() { split_csv_cells(line_, table_.layout.separator, cells_); }

  bool is_text() {
    const auto other = other_content_of(lines_);
    if (other)
      report({Severity::error, 1, CsvFault::not_a_text},
             "is " + other->name + ", not a table; " + other->cure);
    return !other;
  }

  bool read_header() {
    const auto& layout = table_.layout;
    if (layout.is_ambiguous)
      report({Severity::error, 1, CsvFault::ambiguous_number},
             "\"" + layout.ambiguous_cell + "\" may have a decimal sign or one between thousands");
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
      if (layout.misfit_cells > 1) {
        line_number_ = layout.misfit_line;
        report_misfit(layout.misfit_cells);
        return false;
      }
      line_number_ = 1;
      if (const auto cure = cure_for_transposed(lines_.ahead(), layout); !cure.empty()) {
        report({Severity::error, 1, CsvFault::not_a_text}, cure);
        return false;
      }
      report({Severity::error, 1, CsvFault::no_header},
             "no header: a line above the numbers must name the columns");
      return false;
    } else {
      std::string mark;
      const auto names = without_mark(line_, mark);
      const auto skipped = static_cast<std::uint64_t>(names.data() - line_.data());
      split_names(names, layout.header_separator, layout.row_cells, cells_);
      if (layout.has_unused_names) cells_.pop_back();
      for (auto& cell : cells_) cell.column += skipped;
    }
    const std::uint64_t behind = std::exchange(line_number_, header_at);
    name_columns(units);
    line_number_ = layout.header_line == 0 ? 0 : behind;
    return true;
  }

  // Texts of the cells of the present line.
  std::vector<std::string> texts() {
    std::string mark;
    std::vector<std::string> out;
    split_names(without_mark(line_, mark), table_.layout.separator, table_.layout.row_cells, cells_);
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
    // Some programs end every row, but not the header, with a separator.
    if (cells_.size() == place_of_cell_.size() + 1 && cells_.back().text.empty()) cells_.pop_back();
    if (cells_.size() == place_of_cell_.size() + 1 && table_.layout.rows_are_counted)
      cells_.erase(cells_.begin());
    if (cells_.size() == 1 && place_of_cell_.size() > 1) {
      report({Severity::error, 1, CsvFault::ragged_row},
             "\"" + printable_cell(cells_.front().text.substr(0, 40)) + "\" is no row of " +
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
    if (!cells_.empty()) {
      last_cell_ = cells_.back().text.size();
      if (table_.rows() > 0) shortest_cell_ = std::min(shortest_cell_, previous_cell_);
      previous_cell_ = last_cell_;
    }
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
    if (is_silent(cell.text, value)) return kEmpty;
    if ((value && std::isfinite(*value) && std::abs(*value) >= kScpiInfinity) ||
        (!value && is_out_of_range(cell.text))) {
      report({Severity::note, cell.column, CsvFault::out_of_range, name},
             "\"" + printable_cell(cell.text) +
                 "\" is a value beyond the meter's range and is taken for no sample");
      return kEmpty;
    }
    if (value && std::isfinite(*value)) return *value;
    if (const auto* word = value ? nullptr : word_for(cell.text, name)) {
      if (!word->note.empty())
        report({Severity::note, cell.column, CsvFault::word_as_number, name}, std::string(word->note));
      return word->value;
    }
    if (!value)
      if (const auto time = time_in(cell.text)) return time_of(cell, name, *time);
    const bool is_number = value.has_value();
    report({Severity::error, cell.column, is_number ? CsvFault::not_finite : CsvFault::not_a_number, name},
           "\"" + printable_cell(cell.text) + "\" is not a " + (is_number ? "finite " : "") + "number");
    return kEmpty;
  }

  const CsvWord* word_for(std::string_view text, const std::string& name) const {
    const auto same = [](char a, char b) {
      return a == b || ((a | 0x20) == (b | 0x20) && (a | 0x20) >= 'a');
    };
    for (const auto& word : options_.words)
      if (word.column == name && std::ranges::equal(word.text, text, same)) return &word;
    return nullptr;
  }

  // True for a word of [format] no_sample: the same text or the same number (-999 and -999.0).
  bool is_silent(std::string_view text, std::optional<double> value) const {
    return std::ranges::any_of(options_.format.no_sample, [&](const std::string& word) {
      return text == word || (value && number_in_cell(word, {}) == value);
    });
  }

  // With stated frames per second a time code, otherwise a date or a time of day.
  std::optional<CellTime> time_in(std::string_view text) {
    const double frames_per_s = options_.format.frames_per_s;
    const auto code = frames_per_s > 0.0 ? time_code_in(text) : std::nullopt;
    if (!code) return time_in_cell(text, options_.format.day_first.value_or(false));
    frames_.take(*code, line_number_);
    return CellTime{.s = seconds_of(*code, frames_per_s)};
  }

  double time_of(const TableCell& cell, const std::string& name, CellTime time) {
    const bool is_first = name == options_.time_column;
    const bool is_time = options_.time_column.empty() || is_first || name == options_.second_time_column;
    const std::string shown = "\"" + printable_cell(cell.text) + "\" ";
    if (!is_time) {
      report(
          {Severity::error, cell.column, CsvFault::date_in_channel, name},
          shown + "is a date or a time of day, not a number: a spreadsheet may have made it of one like 1.5");
      return kEmpty;
    }
    if (table_.clocks.empty() || table_.clocks.back() != name) table_.clocks.push_back(name);
    if (time.has_unclear_fraction)
      report({Severity::error, cell.column, CsvFault::ambiguous_time, name},
             shown + "ends in less than three digits behind a colon: frames, ms, or a part of a second?");
    if (time.has_two_parts && !options_.format.minutes_first)
      report({Severity::error, cell.column, CsvFault::ambiguous_time, name},
             shown + "may be minutes and seconds, or hours and minutes");
    if (time.has_two_parts && options_.format.minutes_first.value_or(false)) time.s /= 60.0;
    if (time.may_be_day_first && !options_.format.day_first.has_value()) {
      const double day = std::floor(time.s / 86400.0);
      if (day_ && *day_ != day)
        report({Severity::error, cell.column, CsvFault::ambiguous_time, name},
               shown + "follows on another day, and either of its numbers may be the month");
      day_ = day;
    }
    // If the date has its own column it already counts the days.
    return options_.second_time_column.empty() ? times_.seconds(time) : time.s;
  }

  bool time_is_in_order(std::uint64_t column) {
    if (!time_) return true;
    double& time_s = row_[*time_];
    if (std::isnan(time_s)) {
      report({Severity::error, column, CsvFault::no_time, options_.time_column}, "no time; row left out");
      return false;
    }
    if (!options_.check_order) return true;
    const std::string times = " from " + shown_number(times_.last()) + " to " + shown_number(time_s) + " s";
    const auto order = times_.take(time_s, line_number_);
    if (order == CsvRowTimes::Order::grows) return true;
    if (order == CsvRowTimes::Order::went_on) {
      report({Severity::note, column, CsvFault::counter_wrapped, options_.time_column},
             "the counter of 32 bits begins again at 0, and is taken as going on");
      return true;
    }
    if (order == CsvRowTimes::Order::back) {
      report({Severity::error, column, CsvFault::time_backwards, options_.time_column},
             "time goes backwards," + times + "; row left out");
      return false;
    }
    report({Severity::note, column, CsvFault::time_stands_still, options_.time_column},
           "time stands still at " + shown_number(time_s) + " s");
    return true;
  }

  // Rows whose time goes back are reported one by one, or together if they have a common cause.
  void explain_back_steps() {
    const auto kind = times_.back_steps();
    if (kind == CsvRowTimes::BackSteps::slips) return;
    const auto is_back = [](const CsvIssue& issue) { return issue.fault == CsvFault::time_backwards; };
    const auto first = std::ranges::find_if(table_.issues, is_back);
    if (first == table_.issues.end()) return;
    auto issue = *first;
    std::erase_if(table_.issues, is_back);
    issue.fault = CsvFault::several_recordings;
    issue.repeats = 0;
    issue.text = kind == CsvRowTimes::BackSteps::upside_down
                     ? "the time falls from row to row: the table stands upside down, or its time counts down"
                     : "the time begins again in this line: several recordings one below the other, " +
                           times_.recordings() + times_.clock_set_back();
    table_.issues.push_back(std::move(issue));
  }

  // If the last line has no line end and its last cell is shorter than in every other row, the file was cut
  // there.
  void leave_out_cut_row() {
    constexpr std::size_t kFewestRows = 10;
    const bool is_last = !table_.lines.empty() && table_.lines.back() == line_number_;
    if (lines_.last_is_ended() || !is_last || table_.rows() < kFewestRows || last_cell_ >= shortest_cell_)
      return;
    for (auto& column : table_.columns) column.pop_back();
    table_.lines.pop_back();
    report({Severity::error, line_.size() + 1, CsvFault::cut_row},
           "the file ends within this line: its last cell is shorter than in every other row; row left out");
  }

  void report_no_rows() {
    const auto cells = table_.layout.row_cells;
    const bool fits = cells == 0 || cells == place_of_cell_.size();
    line_number_ = std::max<std::uint64_t>(table_.layout.header_line, 1);
    if (fits)
      report({Severity::error, 1, CsvFault::no_rows}, "no rows below the header");
    else
      report_misfit(place_of_cell_.size());
  }
  void report_misfit(std::size_t names) {
    const auto cells = table_.layout.row_cells;
    std::string text = std::to_string(names) + " columns are named here, and the rows have " +
                       std::to_string(cells) + " cells";
    if (cells == 2 * names)
      text += ": twice as many, as decimal commas between commas make; export with points or semicolons";
    report({Severity::error, 1, CsvFault::names_do_not_fit}, std::move(text));
  }

  // Frames that never reach the number that makes a second, or pass it.
  void check_frames() {
    if (const auto doubt = frames_.doubt(options_.format.frames_per_s); !doubt.empty()) {
      line_number_ = frames_.line();
      report({Severity::error, 1, CsvFault::ambiguous_time, options_.time_column}, doubt);
    }
  }

  void note_gaps() {
    if (!time_ || table_.rows() < 3) return;
    const auto& times_s = table_.columns[*time_];
    const double usual_s = median_step_s(times_s);
    if (usual_s <= 0.0) return;
    for (std::size_t i = 0; i + 1 < times_s.size(); ++i) {
      const double step_s = times_s[i + 1] - times_s[i];
      if (step_s <= options_.gap_steps * usual_s) continue;
      line_number_ = table_.lines[i + 1];
      report({Severity::note, 1, CsvFault::gap, options_.time_column},
             "a gap of " + shown_number(step_s) + " s before this row (median step " + shown_number(usual_s) +
                 " s)");
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
  std::vector<std::optional<std::size_t>> place_of_cell_;  // index in the table; none: column not used
  std::optional<std::size_t> time_;
  std::vector<double> row_;
  CsvRowTimes times_{options_.format.time_restarts_at};
  FrameCounts frames_;
  std::optional<double> day_{};  // last date whose day and month may be swapped
  // Length of the last cell in the newest row, in the row before it, and the shortest of all earlier rows.
  std::size_t last_cell_ = 0, previous_cell_ = 0, shortest_cell_ = SIZE_MAX;
};

}  // namespace

CsvTable read_csv(std::istream& in, const CsvReadOptions& options) { return Reading(in, options).run(); }

}  // namespace sandhopper
