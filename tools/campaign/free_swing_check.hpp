#pragma once
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Doubts the unit of the angle of a pendulum that swings free (no torque, or motor_enabled = false):
// - it turns by more than one turn, then back by more than one turn. A pendulum that came to rest has at most
//   the energy of its upright position, so that it stays within one turn;
// - from a stated release_position_rad it swings farther than the geometric mean of rad and degrees times
//   that angle, where energy allows once that angle; or it starts at 1/57.3 of it and goes no farther;
// - it swings about an angle that is nearer to a quarter or half turn than to the hanging position, angle 0;
// - from rest it goes on by more than one turn and never comes back.
void check_free_swing(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                      const RecordingPlaces& places);

}  // namespace sandhopper
