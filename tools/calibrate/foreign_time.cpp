#include "tools/calibrate/foreign_time.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <regex>

#include "tools/calibrate/taps.hpp"

namespace sandhopper::calibrate {
namespace {

struct Unit {
  std::string_view name;
  double seconds;
};
constexpr std::array kUnits{
    Unit{"s", 1.0},   Unit{"ms", 1e-3},      Unit{"us", 1e-6},      Unit{"ns", 1e-9},   Unit{"min", 60.0},
    Unit{"sec", 1.0}, Unit{"\u00b5s", 1e-6}, Unit{"\u03bcs", 1e-6}, Unit{"msec", 1e-3}, Unit{"usec", 1e-6}};
constexpr std::size_t kTried = 5;  // the first five; the rest are other spellings

// Command that removes `mark` from the cells of the time.
std::string removal_of(char mark, const std::string& name, const CsvTable& table, std::uint64_t column) {
  const char separator = table.layout.separator;
  if (separator == mark || separator == ' ') return "export the table again without marks between thousands";
  const std::string divided = separator == '\t' ? "\\t" : std::string(1, separator);
  return fmt::format(
      "remove them: awk -F'{0}' -v OFS='{0}' '{{ gsub(/[{1}]/, \"\", ${2}) }} 1' '{3}' > plain.csv", divided,
      mark, column, name);
}

}  // namespace

std::optional<double> seconds_in(std::string_view unit) {
  constexpr std::string_view kAround = " \t()[]{}";
  const auto first = unit.find_first_not_of(kAround);
  if (first == std::string_view::npos) return std::nullopt;
  unit = unit.substr(first, unit.find_last_not_of(kAround) + 1 - first);
  const auto found = std::ranges::find(kUnits, unit, &Unit::name);
  return found == kUnits.end() ? std::nullopt : std::optional(found->seconds);
}

std::optional<std::string> unit_that_fits(const TapTimes& ours, const Series& foreign) {
  for (std::size_t i = 1; i < kTried; ++i) {
    Series scaled = foreign;
    for (auto& t : scaled.time_s) t *= kUnits[i].seconds;
    std::vector<Refusal> refused;
    const auto taps = find_taps(scaled, {1, ""}, refused);
    if (!refused.empty()) continue;
    if (!tap_alignments(ours, {taps, scaled.time_s.front(), scaled.time_s.back()}).empty())
      return std::string(kUnits[i].name);
  }
  return std::nullopt;
}

std::optional<TimeProblem> times_that_are_no_numbers(const std::string& name, const CsvTable& table) {
  const auto time = std::ranges::find(table.names, "t_s");
  if (time == table.names.end()) return std::nullopt;
  const auto number = table.numbers[static_cast<std::size_t>(time - table.names.begin())];
  const CsvIssue* first = nullptr;
  std::uint64_t bad = 0;
  for (const auto& issue : table.issues) {
    if (issue.fault != CsvFault::not_a_number || issue.name != "t_s") continue;
    if (first == nullptr) first = &issue;
    bad += issue.repeats + 1;
  }
  if (first == nullptr || bad <= table.rows()) return std::nullopt;
  static const std::regex grouped(R"re(^"[-+]?[0-9]{1,3}([.,'])[0-9]{3}(\1[0-9]{3})*".*)re");
  std::smatch found;
  const bool marks = std::regex_match(first->text, found, grouped);
  const std::string line = fmt::format("{}:{}: {} times of t_s are no number and {} are; the first: {}", name,
                                       first->line, bad, table.rows(), first->text);
  if (!marks) return TimeProblem{line, "write the times as plain numbers, 12.345"};
  const char mark = found[1].str().front();
  return TimeProblem{fmt::format("{}: its marks stand between thousands", line),
                     removal_of(mark, name, table, number)};
}

std::optional<TimeProblem> rows_that_stand_twice(const std::string& name, const CsvTable& table,
                                                 const std::vector<double>& time_s) {
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  std::size_t copies = 0;
  bool changes = false;  // constant values would be the same without copies
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    const bool equal = std::ranges::all_of(
        table.columns, [&](const auto& column) { return same(column[i], column[i - 1]); });
    if (equal) ++copies;
    if (time_s[i] == time_s[i - 1] && !equal) return std::nullopt;
    for (const auto& column : table.columns) changes |= &column != &time_s && !same(column[i], column[i - 1]);
  }
  if (2 * copies + 1 < time_s.size() || !changes) return std::nullopt;
  return TimeProblem{fmt::format("{}: {} of {} rows are copies of the row before, time and values: the rows "
                                 "stand twice",
                                 name, copies, time_s.size()),
                     fmt::format("see whether two programs wrote into it; to take each row once: uniq '{}' > "
                                 "once.csv",
                                 name)};
}

std::optional<TimeProblem> times_too_coarse(const std::string& name, const std::vector<double>& time_s,
                                            std::size_t column_number) {
  std::size_t repeated = 0;
  double step_s = 0.0;
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    const double change_s = time_s[i] - time_s[i - 1];
    if (change_s == 0.0) ++repeated;
    if (change_s > 0.0 && (step_s == 0.0 || change_s < step_s)) step_s = change_s;
  }
  if (2 * repeated + 1 < time_s.size() || time_s.size() < 2) return std::nullopt;
  return TimeProblem{
      fmt::format(
          "{}: {} of {} rows have the time of the row before; t_s (column {}) goes on in steps of {:g} "
          "only",
          name, repeated, time_s.size(), column_number, step_s),
      "export the time with more digits, so that each row has its own: a tap lasts some milliseconds"};
}

}  // namespace sandhopper::calibrate
