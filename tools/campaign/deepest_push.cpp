#include "tools/campaign/deepest_push.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/campaign/belief_sources.hpp"
#include "tools/campaign/force_at_depth.hpp"
#include "tools/campaign/read_table.hpp"

namespace sandhopper {
namespace {

// Bearing capacity factor N_q (Prandtl and Reissner) at a friction angle of 20 degrees, that of the
// smoothest dry grains, e^(pi tan phi) tan^2(45 deg + phi / 2): a foot in grains bears N_q rho g z A at
// least.
constexpr double kLeastBearing = 6.4;

double area_of_foot_m2(const IntruderBelief& belief) {
  return std::numbers::pi * belief.foot.radius_m * belief.foot.radius_m;
}

}  // namespace

DeepestPush deepest_push(const TrialRecording& recording) {
  DeepestPush most;
  for (const double z_m : recording.channel("foot_z_m"))
    if (!std::isnan(z_m)) most.depth_m = std::max(most.depth_m, -z_m);
  for (const double force_N : ForceAtDepth(recording).force_N) most.force_N = std::max(most.force_N, force_N);
  return most;
}

double least_bearing_N(const IntruderBelief& belief, double depth_m) {
  return kLeastBearing * kLightestBed_kg_per_m3 * kGravity_mps2 * depth_m * area_of_foot_m2(belief);
}

bool is_said(const Campaign& campaign, std::string_view key) {
  const auto used = used_numbers(campaign);
  return std::ranges::any_of(used.numbers, [&](const UsedNumber& number) {
    return number.key.starts_with(key) && number.source != UsedNumber::Source::plant_default &&
           number.value > 0.0;
  });
}

std::optional<double> believed_bearing_N(const IntruderBelief& belief, double depth_m) {
  const auto& bed = belief.terrain;
  if (bed.rigid || bed.exponent != 1.0) return std::nullopt;
  const double per_m = bed.stiffness_per_area_N_per_m3 > 0.0
                           ? bed.stiffness_per_area_N_per_m3 * area_of_foot_m2(belief)
                           : bed.stiffness_N_per_m;
  return per_m * depth_m;
}

bool is_unit_assumed(const CampaignTrial& trial, const RecordingPlaces& places, std::string_view channel) {
  const auto* used = places.column_of(channel);
  const auto* mapping = mapping_of(trial, channel);
  if (used == nullptr || mapping == nullptr || used->column == channel) return false;
  return mapping->unit.empty() && !used->in_file && std::abs(used->scale) == 1.0;
}

}  // namespace sandhopper
