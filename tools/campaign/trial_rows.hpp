#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "tools/campaign/campaign.hpp"
#include "tools/campaign/check_channels.hpp"
#include "tools/campaign/trial_recording.hpp"

// The rows of a recording once its columns are known.
namespace sandhopper {

// With fewer a channel cannot be judged (check_times, doubt_time need as many); more than one row is kept.
inline constexpr std::size_t kFewSelectedRows = 10;

// Rows whose time, in s, and value in `column` (null: of any value) are selected. Lines are chosen as the
// file is read.
std::vector<std::size_t> selected_rows(const RowSelection& rows, const std::vector<double>& t_s,
                                       const std::vector<double>* column);

// "250 were read from a.csv, from 0 to 0.498 s"
std::string shown_rows(std::string_view file, const std::vector<double>& t_s);

void keep_rows(TrialRecording& recording, RecordingPlaces& places, const std::vector<std::size_t>& keep);

// Rows of one instant become one: later cells fill what the earlier row left empty. With a selection the
// order has not been checked yet; a row that steps back is left out.
void join_equal_times(TrialRecording& recording, RecordingPlaces& places);

// Steps of more than five times the median step, said once with the largest.
void note_gaps(TrialRecording& recording, const RecordingPlaces& places);

}  // namespace sandhopper
