#pragma once
#include <string>

#include "tools/campaign/plant_kind.hpp"

// Remarks of a drafted campaign.toml with the set-up keys of a plant.
namespace sandhopper {

// Keys of [every_trial].
std::string draft_setups(CampaignPlant plant);

// The table [available]: keys that a proposed next trial may use.
std::string draft_available(CampaignPlant plant);

}  // namespace sandhopper
