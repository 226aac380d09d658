#pragma once
#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {

// Computes the torque of a drive that closes a position loop itself and logs its command only. The set-up
// gives the loop for each motor; each key has the prefix stance_ or flight_, chosen by `phase` (0 is flight):
//   …position_gain_Nm_per_rad  kp,  …velocity_gain_Nm_s_per_rad  kd (0),  …target_rad  x0.
// kp (x0 - x) - kd xdot is added to command_left_torque_Nm and command_right_torque_Nm; their mapped values
// are the feed-forward part (0 if not mapped). xdot: the drive's velocity, or else the derivative of the
// angle over +-8 ms. Does nothing without gains, angle or phase.
void add_position_loop(TrialRecording& recording, const CampaignTrial& trial);

}  // namespace sandhopper
