#pragma once
#include "tools/campaign/campaign.hpp"
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Compares a hopper's accelerometers and load cell with its leg (hopper_signals). Reported (implausible):
// - the foot's accelerometer follows the leg's force and the body's does not: exchanged columns;
// - the load cell, in the rows in which it carries load, is the ground's force times another factor than two
//   units allow, by the accelerometers and masses and also by the leg: another unit, or the other sign;
// - the load cell agrees with the accelerometers, and also with the leg, only later or earlier, by more than
//   1/20 of a stance. Shorter delays are for the diagnosis;
// - the leg's force, by the currents, is another one than the load cell's by more than the fourth root of 2
// (a
//   note): half way to effective (rms) currents.
// A force is compared only if it moves with the other one, so a robot that hangs or stands, a dead channel or
// motors without current show nothing. Recordings with a lost trial are not looked at.
void check_hopper_forces(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                         const RecordingPlaces& places);

}  // namespace sandhopper
