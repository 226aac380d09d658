#pragma once
#include <nlohmann/json.hpp>

#include "tools/explain/explanation.hpp"

namespace sandhopper {

// Faults with check, value, limit, meaning, reaction and cure, and the steps of the reaction; without the
// plots.
nlohmann::ordered_json explanation_json(const Explanation& explanation);

}  // namespace sandhopper
