#include "tools/campaign/frozen_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/campaign/trial_rows.hpp"

namespace sandhopper {
namespace {

bool repeats(const std::vector<double>& values, std::size_t row) {
  return values[row] == values[row - 1] || (std::isnan(values[row]) && std::isnan(values[row - 1]));
}

// Channels that differ from the row before in nearly all rows before `end`.
std::size_t lively_channels(const TrialRecording& recording, std::size_t end) {
  std::size_t lively = 0;
  for (const auto& channel : recording.channels) {
    std::size_t changes = 0;
    for (std::size_t row = 1; row < end; ++row) changes += !repeats(channel.values, row);
    lively += 5 * changes >= 4 * (end - 1);
  }
  return lively;
}

void keep_from_to(TrialRecording& recording, RecordingPlaces& places, std::size_t from, std::size_t to) {
  std::vector<std::size_t> keep(to - from);
  std::iota(keep.begin(), keep.end(), from);
  keep_rows(recording, places, keep);
}

void drop_filled_end(TrialRecording& recording, RecordingPlaces& places) {
  constexpr std::size_t kFewest = 10;
  const std::size_t rows = recording.t_s.size();
  std::size_t end = rows;
  while (end > 1 && std::ranges::all_of(recording.channels, [&](const auto& channel) {
           return repeats(channel.values, end - 1);
         }))
    --end;
  // At rest one channel may repeat its value, several that show noise do not.
  if (rows - end < kFewest || end < kFewest || lively_channels(recording, end) < 2) return;
  note_at_row(recording, places, FindingKind::held_samples, end,
              fmt::format("the last {} rows repeat the row before in every channel, as a logger or a "
                          "spreadsheet fills rows; they are left out",
                          rows - end),
              "cut them off the file");
  keep_from_to(recording, places, 0, end);
}

void drop_unset_clock(TrialRecording& recording, RecordingPlaces& places) {
  constexpr double kThreeYears_s = 1e8;
  const auto& t = recording.t_s;
  std::size_t first = 0;
  for (std::size_t row = 1; row < t.size() / 2; ++row)
    if (t[row] - t[row - 1] > kThreeYears_s) first = row;
  if (first == 0) return;
  note_at_row(
      recording, places, FindingKind::gap, 0,
      fmt::format("the clock of the first {} rows was not set yet: the next one is {:.3g} years later; "
                  "they are left out",
                  first, (t[first] - t[first - 1]) / (365.25 * 86400.0)),
      "cut them off the file");
  keep_from_to(recording, places, first, t.size());
}

}  // namespace

void drop_untrue_rows(TrialRecording& recording, RecordingPlaces& places) {
  if (recording.has_time) drop_unset_clock(recording, places);
  drop_filled_end(recording, places);
}

}  // namespace sandhopper
