#pragma once
#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {

// A drive that closes a position loop itself logs what it was told, not its torque. Where the set-up gives
// the loop (per motor, each key with stance_ or flight_ in front, chosen by `phase`: 0 is flight),
//   …position_gain_Nm_per_rad  kp,  …velocity_gain_Nm_s_per_rad  kd (0),  …target_rad  x0,
// the torque kp (x0 - x) - kd xdot is added to command_left_torque_Nm and command_right_torque_Nm, whose
// mapped values are the feed-forward part (0 where there is none). xdot is the drive's, or else the angle's
// own derivative over +-8 ms. Nothing happens without the gains, the angle or the phase.
void add_position_loop(TrialRecording& recording, const CampaignTrial& trial);

}  // namespace sandhopper
