#include "tools/campaign/companion.hpp"

#include <fmt/format.h>

#include <limits>

namespace sandhopper {
namespace {

constexpr std::size_t kNoRow = std::numeric_limits<std::size_t>::max();

// Rows of the two recordings that form one joint row.
struct RowPair {
  double t_s;
  std::size_t first = kNoRow, second = kNoRow;
};

std::vector<RowPair> joint_rows(const std::vector<double>& first, const std::vector<double>& second) {
  std::vector<RowPair> rows;
  std::size_t j = 0;
  while (j < second.size() && second[j] < first.front()) ++j;
  for (std::size_t i = 0; i < first.size(); ++i) {
    for (; j < second.size() && second[j] < first[i]; ++j) rows.push_back({second[j], kNoRow, j});
    const bool same = j < second.size() && second[j] == first[i];
    rows.push_back({first[i], i, same ? j++ : kNoRow});
  }
  return rows;
}

std::vector<double> gathered(const std::vector<double>& values, const std::vector<RowPair>& rows,
                             std::size_t RowPair::*which) {
  std::vector<double> out;
  out.reserve(rows.size());
  for (const auto& row : rows)
    out.push_back(row.*which == kNoRow ? std::numeric_limits<double>::quiet_NaN() : values[row.*which]);
  return out;
}

}  // namespace

CampaignTrial trial_of(const CompanionFile& companion, const CampaignTrial& named_by) {
  CampaignTrial trial;
  trial.name = companion.file.string();
  trial.file = companion.file;
  trial.kind = named_by.kind;
  trial.columns = companion.columns;
  trial.format = companion.format;
  trial.position = named_by.position;
  trial.belief = named_by.belief;
  return trial;
}

void join_companion(TrialRecording& recording, TrialRecording other, const std::string& file) {
  const bool joins = recording.usable() && other.usable();
  for (auto& finding : other.findings) {
    // A companion that cannot be used loses only its channels; the trial stays usable.
    if (finding.severity == FindingSeverity::trial_unusable)
      finding.severity = FindingSeverity::channel_unusable;
    recording.findings.push_back(std::move(finding));
  }
  if (!joins) return;
  const bool has_times = recording.has_time && other.has_time;
  if (has_times && (other.t_s.back() < recording.t_s.front() || recording.t_s.back() < other.t_s.front()))
    recording.findings.push_back(
        {FindingKind::set_up, FindingSeverity::channel_unusable, file, 0, 0, "t_s",
         fmt::format("its times, {:.6g} to {:.6g} s, are outside those of the trial, {:.6g} to {:.6g} s",
                     other.t_s.front(), other.t_s.back(), recording.t_s.front(), recording.t_s.back()),
         "state the offset between the clocks: also = { …, columns = { t_s = { column = \"NAME\", unit = "
         "\"UNIT\", offset = SECONDS } } }"});
  const auto rows = joint_rows(recording.t_s, other.t_s);
  for (auto& channel : recording.channels) channel.values = gathered(channel.values, rows, &RowPair::first);
  for (auto& channel : other.channels)
    if (!recording.has(channel.name))
      recording.channels.push_back({channel.name, gathered(channel.values, rows, &RowPair::second)});
  recording.t_s.clear();
  for (const auto& row : rows) recording.t_s.push_back(row.t_s);
  recording.saturated.insert(recording.saturated.end(), other.saturated.begin(), other.saturated.end());
  recording.unused_columns.insert(recording.unused_columns.end(), other.unused_columns.begin(),
                                  other.unused_columns.end());
}

}  // namespace sandhopper
