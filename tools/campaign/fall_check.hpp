#pragma once
#include "tools/campaign/campaign.hpp"
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Compares the height of a dropped body with a fall: z = z0 + v0 t - a t^2 / 2 by least squares over its way,
// a against g (1 - rho V / m). Reported (implausible):
// - a change of more than v t + g t^2, v the larger of 15 m/s and 1.5 times the stated release speed: faster
//   than a throw and a fall; held samples as the cause if most such steps follow on a row that repeats the
//   height before;
// - an acceleration of more than 1.5 g, or of the ratio of two units of length or time within 5 %, if the
// curve is
//   a parabola: another unit, with its name;
// - a height that begins lowest and ends highest: counted downward. A throw states release_speed_mps;
// - a way that takes more than five times as long as a fall, without a liquid or drag in the belief: a note,
// and an
//   error if the file holds a force that the campaign does not use: the body was pushed.
void check_falls(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                 const RecordingPlaces& places);

}  // namespace sandhopper
