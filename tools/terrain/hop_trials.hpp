#pragma once
#include "tools/terrain/trial_analysis.hpp"

namespace sandhopper {

// Analysis of hops: the firmware's own estimators run on the recorded channels. The stiffness is estimated by
// every treatment in every sample window and by the joint fit, and, if they were recorded, also from load
// cell and motion capture; the estimates are compared with these. It uses the first stride of each trial,
// because later ones land in its crater.
class HopTrials : public TrialAnalysis {
 public:
  std::string_view name() const override { return "hops"; }
  bool takes(CampaignPlant plant, TrialKind kind) const override;
  void analyse(const CampaignTrial& trial, const TrialRecording& recording,
               TrialResult& result) const override;
  CampaignConclusions conclude(std::span<const TrialResult* const> results) const override;
};

// A method of stiffness estimation: its name in a quantity ("quasi_static_ols", …), and its title.
struct StiffnessWay {
  std::string_view name;
  std::string_view title;
  std::string_view color;
};
std::span<const StiffnessWay> stiffness_ways();
// Name of a quantity, such as "stiffness_observer_wls_A_N_per_m".
std::string stiffness_name(std::string_view way, std::string_view window);

// Page, terminal lines and JSON for hop trials (hop_conclusions.cpp).
CampaignConclusions conclude_hops(std::span<const TrialResult* const> results);

}  // namespace sandhopper
