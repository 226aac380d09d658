#pragma once
#include <span>
#include <string_view>
#include <vector>

#include "tools/campaign/check_channels.hpp"
#include "tools/campaign/trial_recording.hpp"

// Values that are not possible on a plant, so that a unit must be wrong. One table of bounds (plausible.cpp),
// each with the physics or the part that gives it; and laws that two channels must keep together:
//   rate of a position = its speed channel              within a factor of 5
//   |height(t) - height(0)| <= 15 m/s t + g t^2         a throw and a fall, with room
//   peak force >= rho g z_max A / 5                     a bed pushes at least with its own weight above the
//   foot
namespace sandhopper {

struct PlausibleBound {
  CampaignPlant plant;
  std::string_view channel;
  double most;              // of the magnitude, in the channel's unit
  std::string_view source;  // of the bound
};
std::span<const PlausibleBound> plausible_bounds();

// Adds findings to a recording: what rules the trial out, or a note where `unit` and `scale` of the channel
// are both written down, so that its experimenter has said that it is so.
void check_plausible(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                     const RecordingPlaces& places);

// Findings for numbers of the belief that no laboratory has: a gravity of 1.0, a body denser than any metal.
std::vector<Finding> implausible_beliefs(const Campaign& campaign);

}  // namespace sandhopper
