#pragma once
#include <string>

#include "tools/diagnose/model/context.hpp"
#include "tools/diagnose/model/reach.hpp"

namespace sandhopper::diagnose {

// Reason why no trial within `reach` can be planned: names the set-up keys of this plant that the campaign
// neither lists under [available] nor has recorded; if none is missing, says that nothing within it can be
// simulated.
std::string why_none_is_planned(PlantKind plant, const Reach& reach);

}  // namespace sandhopper::diagnose
