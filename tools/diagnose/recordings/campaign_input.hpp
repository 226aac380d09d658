#pragma once
#include <string>
#include <vector>

#include "tools/campaign/campaign.hpp"
#include "tools/campaign/trial_recording.hpp"
#include "tools/diagnose/fit/prepare.hpp"

namespace sandhopper::diagnose {

PlantKind kind_of(CampaignPlant plant);

// A campaign's belief as numbers under "table.key". Optional numbers that are not set are left out; true
// becomes 1.
Belief flattened(const sandhopper::Belief& belief);

struct CampaignInput {
  Recordings recordings;
  std::vector<Finding> findings;  // from campaign.toml and from every recording
  std::size_t unusable = 0;       // number of trials that cannot be used
};

// Reads every trial. An error in one trial becomes a finding and does not stop the others. Throws ConfigError
// for an effect of nominal.toml that is not known.
CampaignInput read_campaign(const Campaign& campaign);

}  // namespace sandhopper::diagnose
