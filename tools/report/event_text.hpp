#pragma once
#include <string>

#include "config/node.hpp"
#include "firmware/event.hpp"

namespace sandhopper {

// The values that triggered an event, as words with units: "leg 297.9 mm at -62 mm/s, foot at 1.2 mm".
// `robot` is the configuration that the log carries: it gives the limit of a fault. Null: not known.
std::string values_of(const Event& event, const ConfigNode* robot = nullptr);

}  // namespace sandhopper
