#pragma once
#include "tools/terrain/intrusion_fit.hpp"
#include "tools/terrain/trial_analysis.hpp"

namespace sandhopper {

// Analysis of slow presses of flat plates: the best depth law, its prediction for plates of another size, and
// the compliance of the rig itself, from trials on a rigid stop (kind "clamped").
class PressTrials : public TrialAnalysis {
 public:
  std::string_view name() const override { return "presses"; }
  bool takes(CampaignPlant plant, TrialKind kind) const override;
  void analyse(const CampaignTrial& trial, const TrialRecording& recording,
               TrialResult& result) const override;
  CampaignConclusions conclude(std::span<const TrialResult* const> results) const override;
};

// Page, terminal lines and JSON (press_page.cpp).
CampaignConclusions tell_presses(const IntrusionFit& fit, std::span<const PressTrial> trials);

}  // namespace sandhopper
