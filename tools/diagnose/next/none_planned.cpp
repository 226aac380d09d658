#include "tools/diagnose/next/none_planned.hpp"

#include <fmt/format.h>

#include <vector>

namespace sandhopper::diagnose {
namespace {

// Set-up numbers from which trials of this plant are planned (plants/*/doable_*.cpp).
std::vector<std::string> planned_keys(PlantKind plant) {
  switch (plant) {
    case PlantKind::falling_body:
      return {"release_height_m", "release_speed_mps", "payload_kg"};
    case PlantKind::rotary_axis:
      return {"amplitude_rad", "frequency_Hz", "speed_radps", "position_rad", "release_position_rad"};
    case PlantKind::intruder:
      return {"impact_speed_mps", "depth_m", "plate_diameter_m"};
    case PlantKind::hopper:
      return {"release_height_m", "compression_stiffness_N_per_m"};
  }
  return {};
}

// The trials that doable_*.cpp plans.
std::string planned_trials(PlantKind plant) {
  switch (plant) {
    case PlantKind::falling_body:
      return "a drop";
    case PlantKind::rotary_axis:
      return "a hold, or a profile \"release\", \"sine\", \"chirp\" or \"ramp\"";
    case PlantKind::intruder:
      return "a push with the profile \"stop_and_withdraw\", \"cycles\" or \"through\"";
    case PlantKind::hopper:
      return "a hop";
  }
  return "";
}

}  // namespace

std::string why_none_is_planned(PlantKind plant, const Reach& reach, const std::string& refusal) {
  if (!refusal.empty())
    return fmt::format("None: no trial within what was recorded and [available] lists can be simulated: {}.",
                       refusal);
  std::string missing;
  for (const auto& key : planned_keys(plant))
    if (!reach.knows(key)) missing += (missing.empty() ? "" : ", ") + key;
  if (missing.empty())
    return fmt::format(
        "None: the words and numbers of [available], and the ranges that [sensors] states, exclude every "
        "trial "
        "that is planned for this plant: {}. Widen them in campaign.toml.",
        planned_trials(plant));
  return fmt::format(
      "No trial can be planned from the set-ups of this campaign. List under [available] in campaign.toml "
      "what can be set for the next one; neither listed nor recorded: {} (guide: The recording contract).",
      missing);
}

}  // namespace sandhopper::diagnose
