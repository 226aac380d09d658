#pragma once
#include <span>
#include <string_view>
#include <vector>

#include "tools/campaign/check_channels.hpp"
#include "tools/campaign/trial_recording.hpp"

// Finds values that are impossible on a plant, so that a unit must be wrong: a table of limits with their
// sources (plausible.cpp), and relations between channels:
//   rate of a position = its speed channel              within a factor of 5
//   |height(t) - height(0)| <= 15 m/s t + g t^2         a throw and a fall, with margin
//   peak force >= rho g z_max A / 5                     weight of the displaced material (check_overburden)
namespace sandhopper {

// Largest plausible magnitude of one channel.
struct PlausibleBound {
  CampaignPlant plant;
  std::string_view channel;
  double most;              // limit of the magnitude, in the channel's unit
  std::string_view source;  // source of the limit
};
std::span<const PlausibleBound> plausible_bounds();

// Adds findings to a recording. A finding makes the trial unusable, except if the mapping of the channel
// states both `unit` and `scale`: then the user confirms the values and it is only a note.
void check_plausible(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                     const RecordingPlaces& places);

void check_overburden(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                      const RecordingPlaces& places);

// Findings for impossible numbers of the belief, for example a gravity of 1.0 or a body denser than any
// metal.
std::vector<Finding> implausible_beliefs(const Campaign& campaign);

}  // namespace sandhopper
