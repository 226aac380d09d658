#include "tools/campaign/depth_unit_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "tools/campaign/belief_sources.hpp"
#include "tools/campaign/implausible.hpp"
#include "tools/campaign/read_table.hpp"

namespace sandhopper {
namespace {

// Length / diameter of the most slender probes: hand cone penetrometers reach 71 (0.8 m with 11.3 mm). Deeper
// soundings on a rod must state their unit.
constexpr double kMostDiameters = 100.0;
constexpr double kLightestBed_kg_per_m3 = 100.0;  // expanded polystyrene beads, cork
// Bearing capacity factor N_q (Prandtl and Reissner) at a friction angle of 20 degrees, that of the
// smoothest dry grains, e^(pi tan phi) tan^2(45 deg + phi / 2): a foot in grains bears N_q rho g z A at
// least.
constexpr double kLeastBearing = 6.4;

// True if neither the file nor campaign.toml states the unit of the depth, so that metres are only assumed.
bool is_assumed_in_metres(const CampaignTrial& trial, const RecordingPlaces& places) {
  const auto* used = places.column_of("foot_z_m");
  const auto* mapping = mapping_of(trial, "foot_z_m");
  if (used == nullptr || mapping == nullptr || used->column == "foot_z_m") return false;
  return mapping->unit.empty() && !used->in_file && std::abs(used->scale) == 1.0;
}

struct DeepestPush {
  double depth_m = 0.0, force_N = 0.0;
};

DeepestPush deepest_push(const TrialRecording& recording) {
  DeepestPush most;
  const auto z = recording.channel("foot_z_m");
  const auto* force = recording.find("force_N");
  for (std::size_t i = 0; i < z.size(); ++i) {
    if (std::isnan(z[i])) continue;
    most.depth_m = std::max(most.depth_m, -z[i]);
    if (force != nullptr && !std::isnan((*force)[i])) most.force_N = std::max(most.force_N, (*force)[i]);
  }
  return most;
}

// True if a number whose key begins with `key` is not the plant's default.
bool is_said(const Campaign& campaign, std::string_view key) {
  const auto used = used_numbers(campaign);
  return std::ranges::any_of(used.numbers, [&](const UsedNumber& number) {
    return number.key.starts_with(key) && number.source != UsedNumber::Source::plant_default &&
           number.value > 0.0;
  });
}

// Force of the believed bed at a depth; empty if its stiffness is the plant's default.
std::optional<double> believed_N(const Campaign& campaign, const BedParameters& bed, double area_m2,
                                 double depth_m) {
  if (!is_said(campaign, "terrain.stiffness_") || bed.rigid || bed.exponent != 1.0) return std::nullopt;
  const double per_m = bed.stiffness_per_area_N_per_m3 > 0.0 ? bed.stiffness_per_area_N_per_m3 * area_m2
                                                             : bed.stiffness_N_per_m;
  return per_m * depth_m;
}

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
  const double radius_m = belief.foot.radius_m, area_m2 = std::numbers::pi * radius_m * radius_m;
  const double least_N = kLeastBearing * kLightestBed_kg_per_m3 * kGravity_mps2 * most.depth_m * area_m2;
  if (const auto expected_N = believed_N(campaign, belief.terrain, area_m2, most.depth_m);
      expected_N && most.force_N > 0.0)
    if (const auto unit = nearest_unit(most.force_N / *expected_N); unit != "m")
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
  if (!is_assumed_in_metres(trial, places)) return;
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
