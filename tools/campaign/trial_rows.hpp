#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "tools/campaign/campaign.hpp"
#include "tools/campaign/check_channels.hpp"
#include "tools/campaign/trial_recording.hpp"

// Operations on the rows of a recording after its columns were assigned.
namespace sandhopper {

// With fewer a trial cannot be judged (check_times, doubt_time), and no plant of a diagnosis takes one.
inline constexpr std::size_t kFewestSelectedRows = 10;

// A longer step between two times is a gap, in median steps.
inline constexpr double kLongestStep = 5.0;

// Indices of the rows whose time (s) and value in `column` are selected; null: any value. Selection by line
// is done when the file is read.
std::vector<std::size_t> selected_rows(const RowSelection& rows, const std::vector<double>& t_s,
                                       const std::vector<double>* column);

// "select leaves 4 of 2000 rows, from 0.2 to 0.206 s; 10 are needed, and a.csv goes from 0 to 3.998 s"
std::string selection_text(const RowSelection& rows, const std::vector<double>& t_s,
                           const std::vector<std::size_t>& keep, std::string_view file);

// Adds a note about the time of a row.
void note_at_row(TrialRecording& recording, const RecordingPlaces& places, FindingKind kind, std::size_t row,
                 std::string what, std::string cure);

// Keeps only the given rows, in `recording` and in `places`.
void keep_rows(TrialRecording& recording, RecordingPlaces& places, const std::vector<std::size_t>& keep);

// Joins rows with the same time: later cells fill empty cells of the earlier row. With a selection by column
// the order was not checked before, so a row that goes back in time is left out here.
void join_equal_times(TrialRecording& recording, RecordingPlaces& places);

// Adds one note for all steps of more than five times the median step, at the largest.
void note_gaps(TrialRecording& recording, const RecordingPlaces& places);

}  // namespace sandhopper
