#include "tools/calibrate/foreign_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <regex>

#include "firmware/log/csv_import.hpp"
#include "tools/calibrate/foreign_time.hpp"

namespace sandhopper::calibrate {
namespace {

constexpr std::size_t kShown = 3;

// A table of a calibration has no campaign.toml in which its owner could say how numbers are written.
std::string text_of(const std::string& name, const CsvIssue& issue) {
  if (issue.fault != CsvFault::ambiguous_number) return describe(name, issue);
  return fmt::format("{}:{}:{}: {}; write a point for the decimal sign and no mark between thousands", name,
                     issue.line, issue.column, issue.text);
}

// The first error of each kind with its place and the number of repeats.
std::vector<std::string> problems_of(const std::string& name, const CsvTable& table) {
  std::vector<std::string> out;
  for (const auto& issue : table.issues)
    if (issue.severity == CsvIssue::Severity::error) {
      out.push_back(text_of(name, issue));
      if (issue.repeats > 0)
        out.back() += fmt::format(" ({} more, to line {})", issue.repeats, issue.last_line);
    }
  return out;
}

bool is_decimal_comma(const CsvIssue& issue) {
  static const std::regex comma(R"re(^"[-+]?[0-9]+,[0-9]+".*)re");
  return issue.fault == CsvFault::not_a_number && std::regex_match(issue.text, comma);
}

[[noreturn]] void refuse_clock(const std::string& name, const CsvIssue& issue) {
  throw ForeignTableError(
      fmt::format("{}:{}: its clock goes backwards: {}{}", name, issue.line, issue.text,
                  issue.repeats > 0 ? fmt::format(" ({} rows in all)", issue.repeats + 1) : ""),
      "stop time synchronisation on that computer while it records, or give it the part before or after the "
      "step alone");
}

[[noreturn]] void refuse_several(const std::string& name, const CsvIssue& issue) {
  throw ForeignTableError(fmt::format("{}:{}: {}", name, issue.line, issue.text),
                          "give it one recording with rising time alone");
}

// Seconds in the unit of t_s: the user's word, else that of the table's line of units, else 1.
double scale_of(const CsvTable& table, std::size_t place, const std::string& time_unit,
                std::vector<std::string>& notes) {
  if (!time_unit.empty()) return seconds_in(time_unit).value_or(1.0);
  if (place >= table.units.size()) return 1.0;
  const double scale = seconds_in(table.units[place]).value_or(1.0);
  if (scale != 1.0)
    notes.push_back(fmt::format("t_s is read in {}, by the table's line of units", table.units[place]));
  return scale;
}

void refuse_unreadable(const std::string& name, const std::string& column, const CsvTable& table,
                       std::size_t numbers) {
  auto problems = problems_of(name, table);
  if (problems.empty() && !table.issues.empty()) problems.push_back(describe(name, table.issues.front()));
  if (2 * numbers > table.rows() && table.rows() > 0) return;
  if (std::ranges::any_of(table.issues, is_decimal_comma))
    throw ForeignTableError(
        fmt::format("{}: its cells have decimal commas ({} of {} rows of {} are no number)", name,
                    table.rows() - numbers, table.rows(), column),
        fmt::format("write points: sed 's/,/./g' '{}' > points.csv", name));
  throw ForeignTableError(fmt::format("{}: {} numbers of {} in {} rows{}", name, numbers, column,
                                      table.rows(), problems.empty() ? "" : "; " + problems.front()),
                          "correct the table, or name another column with --foreign-column");
}

}  // namespace

ForeignTable read_foreign_table(const std::filesystem::path& file, const std::string& column,
                                const std::string& time_unit) {
  const auto name = file.string();
  const auto table = read_csv(file, {.list_repeats = false});
  const auto* time = table.find("t_s");
  const auto* value = table.find(column);
  if (time == nullptr || value == nullptr) {
    const auto problems = problems_of(name, table);
    throw ForeignTableError(
        fmt::format("{} has no column {}; it has {}{}", name, time == nullptr ? "t_s" : column,
                    table.names.empty() ? "none" : fmt::format("{}", fmt::join(table.names, ", ")),
                    problems.empty() ? "" : "; " + problems.front()),
        "name the column that shows the taps with --foreign-column; time is t_s");
  }
  for (const auto& issue : table.issues) {
    if (issue.fault == CsvFault::time_backwards) refuse_clock(name, issue);
    if (issue.fault == CsvFault::several_recordings) refuse_several(name, issue);
  }
  if (const auto problem = times_that_are_no_numbers(name, table))
    throw ForeignTableError(problem->text, problem->cure);
  const auto place = static_cast<std::size_t>(time - table.columns.data());
  if (const auto problem = rows_that_stand_twice(name, table, *time))
    throw ForeignTableError(problem->text, problem->cure);
  if (const auto problem = times_too_coarse(name, *time, table.numbers[place]))
    throw ForeignTableError(problem->text, problem->cure);
  ForeignTable out{{file.filename().string(), {}}, 1.0, {}};
  out.time_scale = scale_of(table, place, time_unit, out.notes);
  auto& signal = out.recording.signal;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    if (std::isnan((*value)[i])) continue;
    signal.time_s.push_back((*time)[i] * out.time_scale);
    signal.value.push_back((*value)[i]);
  }
  refuse_unreadable(name, column, table, signal.value.size());
  auto problems = problems_of(name, table);
  if (problems.size() > kShown) problems.resize(kShown);
  out.notes.insert(out.notes.end(), problems.begin(), problems.end());
  return out;
}

}  // namespace sandhopper::calibrate
