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

// Force against depth of plates over trials: which law holds, what it says about plates of another size, and
// how much of the recorded depth is the rig's own elasticity.
namespace sandhopper {

inline constexpr std::array kPredictedDepths_m{0.005, 0.010, 0.020};

// A held-out trial against a law's prediction.
struct PressPrediction {
  std::string trial;
  double diameter_m = 0.0;
  double rms_N = 0.0;
  std::vector<double> measured_N;  // at kPredictedDepths_m; NaN where the trial does not reach
  std::vector<double> predicted_N;
};

struct LawResult {
  DepthLawFit fit;                          // of all fit trials together
  TrialMean stiffness_per_area_N_per_m3{};  // trial by trial
  TrialMean shape{};
  double cross_validation_N = 0.0;  // leave one trial out, root mean square over trials
  std::vector<PressPrediction> predictions;
  // Mean over held-out trials of predicted/measured - 1 at each of kPredictedDepths_m.
  std::vector<double> relative_error;
  double heldout_rms_N = 0.0;  // root mean square over held-out trials
  // Force on the held-out size at each of kPredictedDepths_m, from every fit trial alone: what one press more
  // or less would change.
  std::vector<TrialMean> predicted_N;
};

// What elasticity the recorded depth holds, from trials on a rigid stop and from relieving the bed.
struct RigResult {
  TrialMean stop_compliance_m_per_N{};
  TrialMean stop_unloading_N_per_m{};
  TrialMean toe_m{};
  TrialMean bed_unloading_N_per_m{};  // a bound from below where the recovery is at the resolution
  double compliance_used_m_per_N = 0.0;
  std::string why{};
};

// Force over force at one depth between plates of two sizes, as the exponent p of F ~ A^p.
struct AreaExponent {
  double depth_m = 0.0;
  TrialMean exponent{};
  bool from_held_out = false;  // found afterwards, with the held-out trials
};

struct IntrusionFit {
  RigResult rig;
  std::vector<LawResult> laws;
  // The law with the least cross-validation; of a single trial the one that fits it best.
  std::optional<std::size_t> chosen;
  // Held-out error at the greatest of kPredictedDepths_m under the chosen law, friction angle 5 degrees lower
  // and higher, where the law has one.
  std::optional<std::pair<double, double>> friction_angle_sensitivity;
  std::optional<LawResult> with_stop_compliance;  // the chosen law, the stop's compliance taken off anyway
  std::vector<AreaExponent> area;
  std::size_t fit_trials = 0, held_out_trials = 0;
  DepthLawOptions options;
};

// Only trials that are not held out choose and fit. Needs one trial in a bed.
IntrusionFit fit_intrusions(std::span<const PressTrial> trials);

}  // namespace sandhopper
