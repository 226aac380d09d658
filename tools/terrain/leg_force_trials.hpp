#pragma once
#include "tools/terrain/leg_identification.hpp"
#include "tools/terrain/rigid_ground.hpp"
#include "tools/terrain/trial_analysis.hpp"

namespace sandhopper {

// Analysis of hops on rigid ground with a force plate under the foot: the error of the contact force from the
// motors, with the leg's inertia and friction identified on the hops that are not held out, and a lower bound
// of the ground's stiffness.
class LegForceTrials : public TrialAnalysis {
 public:
  std::string_view name() const override { return "leg_force"; }
  bool takes(CampaignPlant plant, TrialKind kind) const override;
  void analyse(const CampaignTrial& trial, const TrialRecording& recording,
               TrialResult& result) const override;
  CampaignConclusions conclude(std::span<const TrialResult* const> results) const override;
};

// Page, terminal lines and JSON (leg_force_page.cpp).
CampaignConclusions tell_leg(const LegIdentification& leg, const RigidGround& ground);

}  // namespace sandhopper
