#pragma once
#include <string>
#include <vector>

#include "terrain/accelerometer_fusion.hpp"
#include "terrain/falling_body.hpp"
#include "terrain/resistance_law.hpp"
#include "terrain/trial_statistics.hpp"
#include "tools/campaign/trial_recording.hpp"
#include "tools/terrain/trial_result.hpp"

namespace sandhopper {

// A body that fell through a fluid into a bed, evaluated from its accelerometers.
struct PenetrometerDrop {
  std::string trial;
  FusedAcceleration fused;         // its signals are empty after parts were merged
  std::vector<std::string> names;  // channel names of the accelerometers
  double rest_bias_mps2 = 0.0;
  double cos_tilt = 1.0;                  // at rest, from the accelerometers across the axis
  double impact_speed_mps = 0.0;          // at touchdown, integrated backward from rest
  double speed_before_release_mps = 0.0;  // the same integral while the body still hung: its error
  double depth_m = 0.0;
  // Distance from before the fall to rest: integrated, and from the pressure sensor, which lags and is also
  // affected by pressure in the bed. Only a check, not used for results. NaN without pressure.
  double fallen_m = 0.0, fallen_by_pressure_m = 0.0;
  FluidFit fluid;
  double mass_min_kg = 0.0, mass_max_kg = 0.0;
  FluidBody body;                                        // with the middle of the mass range
  Penetration penetration;                               // depth, speed, resistance per moving mass
  std::vector<double> t_s, specific_force_mps2, source;  // around the impact, for figures
};

// Needs accel_mps2 (further ones accel_2_mps2, …). The body's area, volume and the medium's density come from
// the belief, mass_min_kg and mass_max_kg from the set-up. `ruled_out` states why a drop cannot be used.
void keep_drop(const CampaignTrial& trial, const TrialRecording& recording, TrialResult& result);
// Converts the result of keep_drop to the result's series and back (penetrometer_series.cpp).
void keep_numbers(const PenetrometerDrop& drop, TrialResult& result);
bool holds_drop(const TrialResult& result);
PenetrometerDrop drop_from(const TrialResult& result);

struct ResistanceResult {
  ResistanceFit fit;
  TrialMean exponent{}, rate{};   // separate fits of the drops
  double cross_validation = 0.0;  // leave-one-drop-out error: rms relative to the drop's largest resistance
};

struct PenetrometerFit {
  std::vector<ResistanceResult> laws;
  std::size_t chosen = 0;
  std::vector<double> depth_speed_correlation;  // for each drop
};
PenetrometerFit fit_penetrations(const std::vector<PenetrometerDrop>& drops);

}  // namespace sandhopper
