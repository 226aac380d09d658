#pragma once
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "terrain/depth_law.hpp"
#include "terrain/series_compliance.hpp"
#include "terrain/trial_statistics.hpp"
#include "tools/terrain/press_trial.hpp"

// Force against depth of plates over several trials: the best depth law, its prediction for plates of another
// size, and the part of the recorded depth that is the rig's own elasticity.
namespace sandhopper {

inline constexpr std::array kPredictedDepths_m{0.005, 0.010, 0.020};

// Comparison of a held-out trial with the prediction of a law.
struct PressPrediction {
  std::string trial;
  double diameter_m = 0.0;
  double rms_N = 0.0;
  std::vector<double> measured_N;  // at kPredictedDepths_m; NaN if the trial does not reach that depth
  std::vector<double> predicted_N;
};

struct LawResult {
  DepthLawFit fit;                          // fit of all fit trials together
  TrialMean stiffness_per_area_N_per_m3{};  // separate fits of the trials
  TrialMean shape{};
  double cross_validation_N = 0.0;  // leave-one-trial-out error, root mean square over trials
  std::vector<PressPrediction> predictions;
  // Mean over the held-out trials of predicted/measured - 1 at each of kPredictedDepths_m.
  std::vector<double> relative_error;
  double heldout_rms_N = 0.0;  // root mean square over held-out trials
  // Force on the held-out size at each of kPredictedDepths_m, from each fit trial alone. It shows the effect
  // of one press more or less.
  std::vector<TrialMean> predicted_N;
};

// Elasticity in the recorded depth, from trials on a rigid stop and from unloading the bed.
struct RigResult {
  TrialMean stop_compliance_m_per_N{};
  TrialMean stop_unloading_N_per_m{};
  TrialMean toe_m{};
  TrialMean bed_unloading_N_per_m{};  // a lower bound if the recovery is at the resolution
  double compliance_used_m_per_N = 0.0;
  std::string why{};
};

// Ratio of the forces at one depth between plates of two sizes, as the exponent p of F ~ A^p.
struct AreaExponent {
  double depth_m = 0.0;
  TrialMean exponent{};
  bool from_held_out = false;  // calculated afterwards from the held-out trials
};

struct IntrusionFit {
  RigResult rig;
  std::vector<LawResult> laws;
  // The law with the smallest cross-validation error; for a single trial the one with the best fit.
  std::optional<std::size_t> chosen;
  // Held-out error at the largest of kPredictedDepths_m under the chosen law with a friction angle 5 degrees
  // lower and higher, if the law has one.
  std::optional<std::pair<double, double>> friction_angle_sensitivity;
  std::optional<LawResult> with_stop_compliance;  // the chosen law, with the stop's compliance subtracted
                                                  // anyway
  std::vector<AreaExponent> area;
  std::size_t fit_trials = 0, held_out_trials = 0;
  DepthLawOptions options;
};

// Only trials that are not held out are used for choice and fit. Needs one trial in a bed.
IntrusionFit fit_intrusions(std::span<const PressTrial> trials);

}  // namespace sandhopper
