#pragma once
#include "tools/campaign/campaign.hpp"
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Compares a hopper's phases, accelerometers and load cell with free flight, in which nothing carries the
// robot. Reported (implausible):
// - `phase` is flight where the load cell carries load, and stance where it carries none: the flag is
//   inverted. The correlation of the two is then below -1/2. Without a cell: the body's mean specific force
//   is more than g in flight and less than half of it in stance;
// - a specific force whose mean over the hop is nearer to 0 than to 1 g: gravity was subtracted. The mean of
//   a true one is g, but for the change of speed from the first to the last row;
// - the load cell follows the foot's acceleration in flight (a note): a mass hangs below it, and it reads
//   F - m (s - g). Not looked at if `nominal.toml` states that mass.
void check_hopper_flight(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                         const RecordingPlaces& places);

}  // namespace sandhopper
