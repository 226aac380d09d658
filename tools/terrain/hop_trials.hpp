#pragma once
#include "tools/terrain/trial_analysis.hpp"

namespace sandhopper {

// Hops: the firmware's own estimators run on the recorded channels, stiffness by every treatment in every
// sample window and by the joint fit; the same fits on load cell and motion capture where they were recorded,
// and how far the estimates are from those. First stride of each trial; later ones land in its crater.
class HopTrials : public TrialAnalysis {
 public:
  std::string_view name() const override { return "hops"; }
  bool takes(CampaignPlant plant, TrialKind kind) const override;
  void analyse(const CampaignTrial& trial, const TrialRecording& recording,
               TrialResult& result) const override;
  CampaignConclusions conclude(std::span<const TrialResult* const> results) const override;
};

// The ways to a stiffness, as they are named in a quantity: "quasi_static_ols", …, and how they read.
struct StiffnessWay {
  std::string_view name;
  std::string_view title;
  std::string_view color;
};
std::span<const StiffnessWay> stiffness_ways();
// "stiffness_observer_wls_A_N_per_m"
std::string stiffness_name(std::string_view way, std::string_view window);

// Page, terminal lines and JSON of hop trials (hop_conclusions.cpp).
CampaignConclusions conclude_hops(std::span<const TrialResult* const> results);

}  // namespace sandhopper
