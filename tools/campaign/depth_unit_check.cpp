#include "tools/campaign/depth_unit_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "tools/campaign/deepest_push.hpp"
#include "tools/campaign/implausible.hpp"

namespace sandhopper {
namespace {

// Length / diameter of the most slender probes: hand cone penetrometers reach 71 (0.8 m with 11.3 mm). Deeper
// soundings on a rod must state their unit.
constexpr double kMostDiameters = 100.0;
// The unit whose numbers fit the ratio of two forces best: between two units the limit is their geometric
// mean.
std::string_view nearest_unit(double ratio) {
  struct Unit {
    std::string_view name;
    double in_m;
  };
  constexpr std::array kUnits{Unit{"m", 1.0}, Unit{"cm", 0.01}, Unit{"mm", 0.001}};
  return std::ranges::min_element(kUnits, {},
                                  [&](const Unit& unit) { return std::abs(std::log(ratio / unit.in_m)); })
      ->name;
}

// The reason for a doubt, with its arithmetic; empty without one.
std::string doubt_of_metres(const Campaign& campaign, const IntruderBelief& belief, const DeepestPush& most) {
  const double radius_m = belief.foot.radius_m, least_N = least_bearing_N(belief, most.depth_m);
  if (const auto expected_N = believed_bearing_N(belief, most.depth_m); expected_N && most.force_N > 0.0)
    if (const auto unit = nearest_unit(most.force_N / *expected_N);
        unit != "m" && is_said(campaign, "terrain.stiffness_"))
      return fmt::format("{:.3g} N at {:.3g} m, where the believed stiffness gives {:.3g} N: {} fit better",
                         most.force_N, most.depth_m, *expected_N,
                         unit == "cm" ? "centimetres" : "millimetres");
  if (!is_said(campaign, "foot.radius_m")) return "";
  if (most.depth_m > kMostDiameters * 2.0 * radius_m)
    return fmt::format("{:.3g} m is {:.0f} diameters of a foot of {:.3g} m, and penetrometers reach {:.0f}",
                       most.depth_m, most.depth_m / (2.0 * radius_m), 2.0 * radius_m, kMostDiameters);
  if (most.force_N > 0.0 && most.force_N < least_N)
    return fmt::format("{:.3g} N at {:.3g} m, where even grains of {:.0f} kg/m3 bear {:.3g} N", most.force_N,
                       most.depth_m, kLightestBed_kg_per_m3, least_N);
  return "";
}

}  // namespace

void check_depth_unit(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                      const RecordingPlaces& places) {
  const bool pushes = trial.kind == TrialKind::intrusion || trial.kind == TrialKind::press;
  const auto* belief = std::get_if<IntruderBelief>(&trial.belief);
  if (belief == nullptr || !pushes || !recording.has("foot_z_m") || any_unusable(recording.findings)) return;
  if (!is_unit_assumed(trial, places, "foot_z_m")) return;
  const auto why = doubt_of_metres(campaign, *belief, deepest_push(recording));
  if (why.empty()) return;
  const auto* column = places.column_of("foot_z_m");
  auto in_m = *column;
  in_m.unit = "m";
  doubt_column(
      recording, places, false, "foot_z_m",
      fmt::format("neither the file nor campaign.toml states the unit of \"{}\", and metres are unlikely: {}",
                  column->column, why),
      fmt::format("write {} into [columns], or unit = \"mm\", scale = {:g}; or, if metres are right, {}",
                  mapping_line(in_other_unit(*column, 0.01)), 0.001 * column->scale, mapping_line(in_m)));
}

}  // namespace sandhopper
