#pragma once
#include <string>

#include "config/node.hpp"
#include "firmware/event.hpp"

namespace sandhopper {

// Values that triggered an event, with units, for example "leg 297.9 mm at -62 mm/s, foot at 1.2 mm".
// `robot`: configuration in the log, from which the limit of a fault is read; nullptr: not known.
std::string values_of(const Event& event, const ConfigNode* robot = nullptr);

}  // namespace sandhopper
