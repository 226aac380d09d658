#include "tools/terrain/penetrometer_trials.hpp"

namespace sandhopper {

bool PenetrometerTrials::takes(CampaignPlant plant, TrialKind kind) const {
  return plant == CampaignPlant::falling_body && kind == TrialKind::drop;
}

void PenetrometerTrials::analyse(const CampaignTrial& trial, const TrialRecording& recording,
                                 TrialResult& result) const {
  keep_drop(trial, recording, result);
}

CampaignConclusions PenetrometerTrials::conclude(std::span<const TrialResult* const> results) const {
  std::vector<PenetrometerDrop> drops;
  for (const auto* result : results)
    if (holds_drop(*result)) drops.push_back(drop_from(*result));
  if (drops.empty()) return {};
  return tell_penetrations(fit_penetrations(drops), drops);
}

}  // namespace sandhopper
