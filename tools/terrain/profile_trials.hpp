#pragma once
#include "tools/terrain/strength_pool.hpp"
#include "tools/terrain/trial_analysis.hpp"

namespace sandhopper {

// Strength profile of the ground over depth, pooled over trials of any sort that gives force and depth. The
// curves of hops, presses and strokes are kept by their own analyses; a drop's needs the rate law of all
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

// Held-out curves against the band that a group gives for their size of foot.
struct ProfilePrediction {
  std::string law{};   // "area law"
  std::string text{};  // how the force is carried over to the other foot
  CurveSource source = CurveSource::rig;
  double from_diameter_m = 0.0, diameter_m = 0.0;
  std::vector<PooledDepth> band{};
  std::vector<CurveInBand> trials{};
};

struct ProfileConclusion {
  std::vector<CurveGroup> groups{};
  std::vector<StrengthCurve> held_out{};
  std::vector<ProfilePrediction> predictions{};
  std::vector<std::string> notes{};  // said below the figures
};

// `laws`: further ways, besides the area, to carry a press over to another plate; found on trials that are
// not held out.
struct AreaWay {
  std::string law{};
  std::string text{};
  std::function<double(double depth_m, double from_diameter_m, double to_diameter_m)> ratio{};
};
ProfileConclusion conclude_profile(std::span<const StrengthCurve> curves, std::span<const AreaWay> laws);

// Terminal, JSON, table and page (profile_page.cpp).
CampaignConclusions tell_profile(const ProfileConclusion& conclusion);

}  // namespace sandhopper
