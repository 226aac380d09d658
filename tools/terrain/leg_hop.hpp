#pragma once
#include <string>
#include <vector>

#include "estimation/leg.hpp"
#include "tools/campaign/trial_recording.hpp"
#include "tools/terrain/trial_result.hpp"

namespace sandhopper {

// One hop on a force plate: the motors' measurements, and the plate's force at its own rate.
struct LegHop {
  std::string trial;
  bool held_out = false;
  double contact_settling_s = 0.0;  // from the set-up: time for which the plate rings after the landing
  std::vector<double> t_s{};        // times of the rows with an angle
  std::vector<double> angle_rad{};
  std::vector<double> torque_Nm{};  // sum of all motors, on the upper links
  std::vector<double> stance{};     // 1 while the controller takes the foot to be on the ground
  std::vector<double> reference_t_s{};
  std::vector<double> reference_N{};  // as recorded, tare not subtracted
  LegParameters leg{};                // believed parameters
};

// Needs motor position and command torque of at least one side, phase and load_cell_force_N. If something is
// missing, `ruled_out` names it and `series` is not changed. The hop is stored in the trial's series, so that
// parts of a campaign can be merged.
void keep_leg_hop(const CampaignTrial& trial, const TrialRecording& recording, TrialResult& result);
bool holds_leg_hop(const TrialResult& result);
LegHop leg_hop_from(const TrialResult& result);

}  // namespace sandhopper
