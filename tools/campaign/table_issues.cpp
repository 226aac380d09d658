#include "tools/campaign/table_issues.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/campaign/cell_cures.hpp"

namespace sandhopper {
namespace {

using enum FindingSeverity;

constexpr std::uint64_t kMostSlips = 3;

struct FaultMeaning {
  FindingKind kind;
  FindingSeverity severity;
};

FaultMeaning meaning_of(CsvFault fault) {
  using enum CsvFault;
  switch (fault) {
    case no_header:
      return {FindingKind::no_header, trial_unusable};
    case no_rows:
      return {FindingKind::empty_file, trial_unusable};
    case no_time_column:
      return {FindingKind::no_time, trial_unusable};
    case duplicate_column:
      return {FindingKind::duplicate_column, channel_unusable};
    case ragged_row:
      return {FindingKind::ragged_row, note};
    case not_a_number:
      return {FindingKind::non_numeric_cell, note};
    case not_finite:
      return {FindingKind::nan_cell, note};
    case no_time:
      return {FindingKind::no_time, note};
    case time_backwards:
      return {FindingKind::time_backwards, note};
    case time_stands_still:
      return {FindingKind::time_stands_still, note};
    case gap:
      return {FindingKind::gap, note};
    case word_as_number:
      return {FindingKind::file_format, note};
    case date_in_channel:
      return {FindingKind::non_numeric_cell, note};
    case ambiguous_time:
      return {FindingKind::file_format, trial_unusable};
    case out_of_range:
      return {FindingKind::saturated, note};
    case counter_wrapped:
      return {FindingKind::time_backwards, note};
    case several_recordings:
      return {FindingKind::time_backwards, trial_unusable};
    case cut_row:
      return {FindingKind::ragged_row, note};
    case names_do_not_fit:
      return {FindingKind::no_header, trial_unusable};
    case not_a_text:
    case ambiguous_number:
      return {FindingKind::file_format, trial_unusable};
  }
  return {FindingKind::unreadable_file, trial_unusable};
}

std::string repeats(const CsvIssue& issue) {
  if (issue.repeats == 0) return "";
  return fmt::format(" (and {} more like it, the last in line {})", issue.repeats, issue.last_line);
}

std::uint64_t samples_in(const std::vector<double>& column) {
  return static_cast<std::uint64_t>(
      std::count_if(column.begin(), column.end(), [](double value) { return !std::isnan(value); }));
}

bool drops_rows(CsvFault fault) {
  return fault == CsvFault::ragged_row || fault == CsvFault::no_time || fault == CsvFault::time_backwards;
}

// True if the rows without a time are all behind the last one with a time, and their cells are empty: of
// recordings side by side in one table, this one is the shorter.
bool ends_before_table(const CsvIssue& issue, const CsvTable& table) {
  if (issue.fault != CsvFault::no_time || table.lines.empty() || issue.line <= table.lines.back())
    return false;
  return std::ranges::none_of(table.issues, [&](const CsvIssue& other) {
    return other.name == issue.name && other.fault != CsvFault::no_time &&
           std::max(other.line, other.last_line) >= issue.line;
  });
}

Finding end_of_recording(const CsvIssue& issue, const CsvTable& table, const std::string& file) {
  return {FindingKind::no_time,
          note,
          file,
          issue.line,
          issue.column,
          issue.name,
          fmt::format("ends with line {}; the {} rows below it have no time and are not used",
                      table.lines.back(), issue.repeats + 1),
          ""};
}

FindingSeverity severity_of(const CsvIssue& issue, const TrialTable& table, const CampaignTrial& trial) {
  const std::uint64_t count = issue.repeats + 1;
  const bool in_cells = issue.fault == CsvFault::not_a_number || issue.fault == CsvFault::not_finite ||
                        issue.fault == CsvFault::date_in_channel || issue.fault == CsvFault::out_of_range;
  const auto* column = table.table.find(issue.name);
  if (in_cells && column != nullptr && count * 5 > samples_in(*column) + count) return channel_unusable;
  if (issue.fault == CsvFault::duplicate_column && column == time_column(table.table, trial))
    return trial_unusable;
  // A few rows in the wrong order are tolerated. Many mean that the clock was set back, and the time is lost.
  if (issue.fault == CsvFault::time_backwards && count > kMostSlips + table.table.rows() / 100)
    return trial_unusable;
  return meaning_of(issue.fault).severity;
}

// A hop is cut into its phases by these names: one that is not known would move its parts in silence.
Finding unknown_phase(const CsvIssue& issue, const std::string& file) {
  const auto word = issue.text.substr(0, issue.text.rfind(" is not a number"));
  return {FindingKind::non_numeric_cell,
          trial_unusable,
          file,
          issue.line,
          issue.column,
          issue.name,
          fmt::format("{} is no phase{}", word, repeats(issue)),
          fmt::format("write {}, or 0, 1, 2", phase_names())};
}

}  // namespace

void translate_issues(const Campaign& campaign, const CampaignTrial& trial, TrialTable& table,
                      std::vector<Finding>& findings) {
  std::uint64_t dropped = 0, line = 0;
  for (const auto& issue : table.table.issues) {
    const std::uint64_t count = issue.repeats + 1;
    if (issue.fault == CsvFault::no_time_column && !table.table.names.empty()) continue;
    if (campaign.plant == CampaignPlant::hopper && issue.fault == CsvFault::not_a_number &&
        issue.name == phase_column(trial)) {
      findings.push_back(unknown_phase(issue, table.file));
      continue;
    }
    if (ends_before_table(issue, table.table)) {
      findings.push_back(end_of_recording(issue, table.table, table.file));
      continue;
    }
    const auto severity = severity_of(issue, table, trial);
    if (severity == channel_unusable || issue.fault == CsvFault::duplicate_column)
      table.unusable_columns.push_back(issue.name);
    if (drops_rows(issue.fault)) dropped += count;
    if (drops_rows(issue.fault) && line == 0) line = issue.line;
    // A time that falls in every third row is no clock that was set back.
    const bool are_steps = issue.fault == CsvFault::time_backwards && 3 * count > table.table.rows() + count;
    findings.push_back({meaning_of(issue.fault).kind, severity, table.file, issue.line, issue.column,
                        issue.name, issue.text + repeats(issue),
                        are_steps
                            ? "if the column holds the time since the row before, export the time itself, "
                              "or leave the column away and write [format] row_every_s = its mean in s"
                            : cure_for_cells(issue, table.table.layout.separator)});
  }
  if (dropped * 5 > table.table.rows())
    findings.push_back({FindingKind::unreadable_file, trial_unusable, table.file, line, 1, "",
                        fmt::format("{} of {} rows had to be left out, too many to trust the rest", dropped,
                                    dropped + table.table.rows()),
                        "repair the file"});
}

}  // namespace sandhopper
