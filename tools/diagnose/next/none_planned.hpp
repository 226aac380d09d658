#pragma once
#include <string>

#include "tools/diagnose/model/context.hpp"
#include "tools/diagnose/model/reach.hpp"

namespace sandhopper::diagnose {

// Reason why no trial within `reach` can be planned: names the set-up keys of this plant that the campaign
// neither lists under [available] nor has recorded. If none is missing: `refusal`, the plant's reason for a
// trial that cannot be simulated, or that [available] excludes every trial that is planned for this plant.
std::string why_none_is_planned(PlantKind plant, const Reach& reach, const std::string& refusal = "");

}  // namespace sandhopper::diagnose
