#pragma once
#include <vector>

#include "firmware/log/csv_layout.hpp"
#include "tools/campaign/trial_recording.hpp"
#include "tools/campaign/used_column.hpp"

namespace sandhopper {

// Places of a recording in its file, for findings.
struct RecordingPlaces {
  std::string file;
  std::vector<std::uint64_t> lines{};    // line of each row
  std::vector<std::uint64_t> numbers{};  // column of each channel, from 1
  CsvFormat format{};                    // as the user states it
  std::vector<UsedColumn> columns{};     // of the channels and of the time

  const UsedColumn* column_of(std::string_view channel) const;
  // Line of a row of the recording; that of a table with one header line if the lines are not known.
  std::uint64_t line_of(std::size_t row) const { return row < lines.size() ? lines[row] : row + 2; }
  bool is_stated(std::string_view channel) const;  // True if its mapping states unit and scale.

  // Character at which the cell of a column begins in a line; 1 for a log, which has no characters.
  std::uint64_t character(std::uint64_t line, std::uint64_t number) const;
};
// Finds channels that stop measuring: saturated (the same extreme value for many samples, reached and left
// abruptly) or stuck (one value while other channels move). Held values of slow sensors, rest before and
// after the motion and channels that are constant by nature are accepted. Saturation is listed in
// `recording.saturated`. A channel that is stuck or saturated for at least a fifth of its samples is removed;
// if it is saturated, or constant throughout, it is kept in `recording.at_one_value`.
void check_channels(TrialRecording& recording, CampaignPlant plant, const RecordingPlaces& places);

}  // namespace sandhopper
