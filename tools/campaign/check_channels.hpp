#pragma once
#include <vector>

#include "firmware/log/csv_layout.hpp"
#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {

// Looks for channels that stop measuring: at the end of their range (the same extreme value over and over,
// reached and left at once) or stuck (one value while the rest of the recording moves). Held values of slow
// sensors, rest before and after the motion, and channels that are constant by nature are left alone.
// Saturation is listed in `recording.saturated`; a channel that stands still or at its limit for a fifth of
// its samples is removed; at its limit or at one value throughout it is kept apart in
// `recording.at_one_value`.
struct RecordingPlaces {
  std::string file;
  std::vector<std::uint64_t> lines{};    // of the rows
  std::vector<std::uint64_t> numbers{};  // of the channels' columns, from 1
  CsvFormat format{};                    // as its owner states it

  // At which a column's cell begins in a line; 1 in a log, which has no characters.
  std::uint64_t character(std::uint64_t line, std::uint64_t number) const;
};
void check_channels(TrialRecording& recording, CampaignPlant plant, const RecordingPlaces& places);

}  // namespace sandhopper
