#pragma once
#include "tools/campaign/campaign.hpp"

namespace sandhopper::diagnose {

// Throws ConfigError if [effects] of the campaign's model names an effect, a channel or a parameter that the
// plant does not have; with its line and the nearest names. An effect that only this campaign cannot show is
// no error.
void refuse_unknown_effects(const Campaign& campaign);

}  // namespace sandhopper::diagnose
