#pragma once
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Compares force and depth of a press. Notes: a force above the surface, where nothing touches the foot, and
// no force over more than the first half of the depth (the depth is counted from elsewhere). A foot that
// moves by less than a tenth of a millimetre in all is in doubt: millimetres were read as metres.
// `surface_m`: the depth of the surface that check_surface_onset has noted. Above depth 0 a force is then the
// bed's, and no zero of the cell.
void check_surface(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                   const RecordingPlaces& places, double surface_m);

// Mean force above the surface if it is clearly not zero; else 0. Needs `force_N` and `foot_z_m`.
double untared_force_N(const TrialRecording& recording);

}  // namespace sandhopper
