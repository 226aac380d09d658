#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "tools/campaign/campaign.hpp"
#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {

// Fingerprint of a recording's samples: channels and values, not times. 0 for a recording that another one
// could equal by chance.
std::uint64_t fingerprint_of(const TrialRecording& recording);

// Finds one recording that a campaign lists twice, also under another name or with another set-up. Noise
// never repeats, so a second trial with the same samples is no second measurement.
class RepeatedRecordings {
 public:
  // The finding of a trial whose samples an earlier one has; it makes the trial unusable.
  std::optional<Finding> add(const CampaignTrial& trial, std::uint64_t fingerprint);

 private:
  std::map<std::uint64_t, const CampaignTrial*> first_;
};

}  // namespace sandhopper
