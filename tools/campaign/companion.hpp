#pragma once
#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {

// A companion file as a trial of its own, with the kind and belief of the trial that names it.
CampaignTrial trial_of(const CompanionFile& companion, const CampaignTrial& named_by);

// Merges another recording with the same clock into `recording`: rows of both in the order of time, NaN where
// a channel has no sample. Rows of `other` before the first or after the last row of `recording` are left
// out. If both have a channel, that of `recording` is kept. The findings of `other` are added; if it cannot
// be used, `recording` stays otherwise unchanged. A finding says if the times of the two do not overlap.
// `file`: that of `other`.
void join_companion(TrialRecording& recording, TrialRecording other, const std::string& file);

}  // namespace sandhopper
