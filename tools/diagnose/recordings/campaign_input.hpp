#pragma once
#include <string>
#include <vector>

#include "tools/campaign/campaign.hpp"
#include "tools/campaign/trial_recording.hpp"
#include "tools/diagnose/fit/prepare.hpp"

namespace sandhopper::diagnose {

// Every number of a belief under "table.key"; absent options are absent, true is 1.
Belief flattened(const sandhopper::Belief& belief);

struct CampaignInput {
  Recordings recordings;
  std::vector<Finding> findings;  // of campaign.toml and of every recording
  std::size_t unusable = 0;       // trials that gave nothing
};

// Reads every trial; what is wrong with one never stops another.
CampaignInput read_campaign(const Campaign& campaign);

}  // namespace sandhopper::diagnose
