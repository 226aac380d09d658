#pragma once
#include "tools/terrain/strength_pool.hpp"
#include "tools/terrain/trial_analysis.hpp"

namespace sandhopper {

// Strength profile of the ground over depth, pooled over all kinds of trials that give force and depth. The
// analyses of hops, presses and strokes store their own curves. A drop's curve needs the rate law of all
// drops and is made here.
class ProfileTrials : public TrialAnalysis {
 public:
  std::string_view name() const override { return "profile"; }
  bool takes(CampaignPlant plant, TrialKind kind) const override;
  void analyse(const CampaignTrial& trial, const TrialRecording& recording,
               TrialResult& result) const override;
  CampaignConclusions conclude(std::span<const TrialResult* const> results) const override;
};

inline constexpr std::string_view kAreaLaw = "area law";

// Comparison of held-out curves with the band that a group predicts for their size of foot.
struct ProfilePrediction {
  std::string law{};   // name of the law, such as "area law"
  std::string text{};  // description of the scaling from one foot to the other
  CurveSource source = CurveSource::rig;
  double from_diameter_m = 0.0, diameter_m = 0.0;
  std::vector<PooledDepth> band{};
  std::vector<CurveInBand> trials{};
};

struct ProfileConclusion {
  std::vector<CurveGroup> groups{};
  std::vector<StrengthCurve> held_out{};
  std::vector<ProfilePrediction> predictions{};
  std::vector<std::string> notes{};  // notes below the figures
};

// A further method, besides the area law, to scale a press to another plate. It is fitted on trials that are
// not held out.
struct AreaWay {
  std::string law{};
  std::string text{};
  std::function<double(double depth_m, double from_diameter_m, double to_diameter_m)> ratio{};
};
ProfileConclusion conclude_profile(std::span<const StrengthCurve> curves, std::span<const AreaWay> laws);

// Terminal lines, JSON, table and page (profile_page.cpp).
CampaignConclusions tell_profile(const ProfileConclusion& conclusion);

}  // namespace sandhopper
