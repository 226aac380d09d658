#pragma once
#include <string>
#include <string_view>

#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Adds a finding (implausible) at the first row of the recording.
void add_implausible(TrialRecording& recording, const RecordingPlaces& places, FindingSeverity severity,
                     std::string_view channel, std::string what, std::string cure);

// Adds a doubt about a column: the trial is lost. If the user states unit and scale in [columns] (`stated`),
// it is a note, and its cure says that they were taken as stated.
void doubt_column(TrialRecording& recording, const RecordingPlaces& places, bool stated,
                  std::string_view channel, std::string what, std::string cure);

}  // namespace sandhopper
