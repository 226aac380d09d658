#pragma once
#include <string>
#include <vector>

#include "tools/campaign/campaign.hpp"
#include "tools/campaign/check_channels.hpp"
#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {

// The checks of a press whose depth and force stand in two files. Each file alone gave no reason for them.
// Take it before the files are joined, because it keeps the places of both.
class JoinedPress {
 public:
  JoinedPress(const TrialRecording& first, const RecordingPlaces& places, const TrialRecording& second,
              const RecordingPlaces& other_places);

  // Adds the findings to the joined recording, each with the file of its channel.
  void check(TrialRecording& joined, const Campaign& campaign, const CampaignTrial& trial) const;

 private:
  // Places for rows at `t_s`: the lines are those of the file with the force.
  RecordingPlaces places_at(const std::vector<double>& t_s) const;

  bool is_new_ = false;           // Only the two files together have depth and force.
  bool force_is_second_ = false;  // The force is in the second file.
  RecordingPlaces first_, second_;
  std::vector<double> force_t_s_;
};

}  // namespace sandhopper
