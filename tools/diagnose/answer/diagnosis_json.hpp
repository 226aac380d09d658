#pragma once
#include <nlohmann/json.hpp>

#include "tools/diagnose/answer/diagnosis.hpp"

namespace sandhopper::diagnose {

// The diagnosis as the JSON object of diagnosis.json.
nlohmann::ordered_json to_json(const Diagnosis& diagnosis);

}  // namespace sandhopper::diagnose
