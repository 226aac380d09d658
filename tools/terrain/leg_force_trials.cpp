#include "tools/terrain/leg_force_trials.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace sandhopper {

bool LegForceTrials::takes(CampaignPlant plant, TrialKind kind) const {
  return plant == CampaignPlant::hopper && kind == TrialKind::hop;
}

void LegForceTrials::analyse(const CampaignTrial& trial, const TrialRecording& recording,
                             TrialResult& result) const {
  const auto* belief = std::get_if<HopperBelief>(&trial.belief);
  if (belief != nullptr && belief->terrain.rigid) keep_leg_hop(trial, recording, result);
}

CampaignConclusions LegForceTrials::conclude(std::span<const TrialResult* const> results) const {
  std::vector<LegHop> hops;
  for (const auto* result : results)
    if (holds_leg_hop(*result)) hops.push_back(leg_hop_from(*result));
  if (hops.empty()) return {};
  try {
    const auto leg = identify_leg(hops, {});
    const double mass_kg = leg.mass_kg.trials > 0 ? leg.mass_kg.value : leg.believed_mass_kg;
    return tell_leg(leg, rigid_ground(hops, leg.tare_N, mass_kg));
  } catch (const std::invalid_argument& error) {
    CampaignConclusions out;
    out.lines.push_back(fmt::format("The leg's force estimate is not identified: {}.", error.what()));
    return out;
  }
}

}  // namespace sandhopper
