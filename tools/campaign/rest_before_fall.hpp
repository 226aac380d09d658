#pragma once
#include <optional>
#include <span>

#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Time that a body rests before it falls from rest, from the first height, by least squares over the first
// half of its way:  h = h0 - b max(0, t - rest)^2,  b free. Empty unless the rest is longer than a row and
// the misfit without it is larger by 16 variances of a height (4 standard errors). Drag bends a fall the
// other way, so that it shows no rest.
std::optional<double> rest_before_fall_s(std::span<const double> time_s, std::span<const double> height_m);

// Notes the rest before a drop from a stated release_height_m, with the line of campaign.toml that leaves its
// rows out.
void check_rest_before_fall(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                            const RecordingPlaces& places);

}  // namespace sandhopper
