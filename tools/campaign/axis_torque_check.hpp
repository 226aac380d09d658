#pragma once
#include "tools/campaign/campaign.hpp"
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Compares the recorded torque of an axis with its believed inertia. Over windows of 1/40 of the rows,
//   integral of torque dt = I dv + G integral of sin(position) dt + b dx + c integral of sgn(v) dt + o T
// is fitted by least squares. Where that explains 80 % of the variance and I is 20 standard errors from 0, I
// is compared with `axis.inertia_kg_m2`. Reported (implausible) if the two differ by more than a factor of 5
// or in sign: an error if the ratio is that of two units within a factor of 1.3, above 20 or negative; else a
// note, because an elastic joint hides part of an inertia. Not looked at where the position is in doubt.
void check_axis_torque(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                       const RecordingPlaces& places);

}  // namespace sandhopper
