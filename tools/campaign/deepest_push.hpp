#pragma once
#include <optional>
#include <string_view>

#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

inline constexpr double kLightestBed_kg_per_m3 = 100.0;  // expanded polystyrene beads, cork

// The deepest depth and the largest force of a foot that is pushed in.
struct DeepestPush {
  double depth_m = 0.0, force_N = 0.0;
};
DeepestPush deepest_push(const TrialRecording& recording);

// Force that grains bear at least under the believed foot, N_q rho g z A of the lightest and smoothest.
double least_bearing_N(const IntruderBelief& belief, double depth_m);

// Force of the believed bed at a depth; empty if its law is no straight line. The stiffness may be the
// plant's default (is_said).
std::optional<double> believed_bearing_N(const IntruderBelief& belief, double depth_m);

// True if a number whose key begins with `key` is not the plant's default. Looks at all trials: ask it last.
bool is_said(const Campaign& campaign, std::string_view key);

// True if neither the file nor campaign.toml states the unit of a channel's column, so that that of the
// channel is only assumed.
bool is_unit_assumed(const CampaignTrial& trial, const RecordingPlaces& places, std::string_view channel);

}  // namespace sandhopper
