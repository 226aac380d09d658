#include "tools/calibrate/foreign_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <regex>

#include "firmware/log/csv_import.hpp"

namespace sandhopper::calibrate {
namespace {

constexpr std::size_t kShown = 3;

// The first error of each kind with its place and the number of repeats.
std::vector<std::string> problems_of(const std::string& name, const CsvTable& table) {
  std::vector<std::string> out;
  for (const auto& issue : table.issues)
    if (issue.severity == CsvIssue::Severity::error) {
      out.push_back(describe(name, issue));
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

ForeignTable read_foreign_table(const std::filesystem::path& file, const std::string& column) {
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
  ForeignTable out{{file.filename().string(), {}}, {}};
  auto& signal = out.recording.signal;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    if (std::isnan((*value)[i])) continue;
    signal.time_s.push_back((*time)[i]);
    signal.value.push_back((*value)[i]);
  }
  refuse_unreadable(name, column, table, signal.value.size());
  out.notes = problems_of(name, table);
  if (out.notes.size() > kShown) out.notes.resize(kShown);
  return out;
}

}  // namespace sandhopper::calibrate
