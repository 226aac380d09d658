#pragma once
#include <string>
#include <vector>

#include "terrain/depth_law.hpp"
#include "tools/campaign/trial_recording.hpp"
#include "tools/terrain/trial_result.hpp"

namespace sandhopper {

// A plate pressed slowly into a bed, or the same rig pressed on a rigid stop.
struct PressTrial {
  std::string trial;
  bool on_stop = false;  // kind = "clamped"
  bool held_out = false;
  double friction_angle_rad = 0.0;
  DepthTrial loading;                       // while the plate moves down
  std::vector<double> path_displacement_m;  // from the start of loading on, including unloading
  std::vector<double> path_force_N;
};

// Needs foot_z_m (zero at the undisturbed surface) and force_N. Set-up: plate_diameter_m, loading_from_s and
// loading_to_s (otherwise from the first depth to the deepest), held_out, friction_angle_deg (default 30). If
// the force is held over several rows only rows with a fresh value count. `ruled_out` names what is missing.
void keep_press(const CampaignTrial& trial, const TrialRecording& recording, TrialResult& result);
bool holds_press(const TrialResult& result);
PressTrial press_from(const TrialResult& result);

}  // namespace sandhopper
