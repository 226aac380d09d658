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

// With fewer a trial cannot be judged (check_times, doubt_time), and no plant of a diagnosis takes one.
inline constexpr std::size_t kFewestSelectedRows = 10;

// Rows whose time, in s, and value in `column` (null: of any value) are selected. Lines are chosen as the
// file is read.
std::vector<std::size_t> selected_rows(const RowSelection& rows, const std::vector<double>& t_s,
                                       const std::vector<double>* column);

// "select leaves 4 of 2000 rows, from 0.2 to 0.206 s; 10 are needed, and a.csv goes from 0 to 3.998 s"
std::string told_selection(const RowSelection& rows, const std::vector<double>& t_s,
                           const std::vector<std::size_t>& keep, std::string_view file);

void keep_rows(TrialRecording& recording, RecordingPlaces& places, const std::vector<std::size_t>& keep);

// Rows of one instant become one: later cells fill what the earlier row left empty. With a selection the
// order has not been checked yet; a row that steps back is left out.
void join_equal_times(TrialRecording& recording, RecordingPlaces& places);

// Steps of more than five times the median step, said once with the largest.
void note_gaps(TrialRecording& recording, const RecordingPlaces& places);

}  // namespace sandhopper
