#pragma once
#include "tools/terrain/penetrometer.hpp"
#include "tools/terrain/trial_analysis.hpp"

namespace sandhopper {

// Analysis of bodies with accelerometers that fall through a fluid into a bed: resistance of the bed against
// depth and speed.
class PenetrometerTrials : public TrialAnalysis {
 public:
  std::string_view name() const override { return "penetrations"; }
  bool takes(CampaignPlant plant, TrialKind kind) const override;
  void analyse(const CampaignTrial& trial, const TrialRecording& recording,
               TrialResult& result) const override;
  CampaignConclusions conclude(std::span<const TrialResult* const> results) const override;
};

// Page, terminal lines and JSON (penetrometer_page.cpp).
CampaignConclusions tell_penetrations(const PenetrometerFit& fit, const std::vector<PenetrometerDrop>& drops);

}  // namespace sandhopper
