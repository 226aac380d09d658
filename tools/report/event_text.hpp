#pragma once
#include <string>

#include "firmware/event.hpp"

namespace sandhopper {

// The values that triggered an event, as words with units: "leg 297.9 mm at -62 mm/s, foot at 1.2 mm".
std::string values_of(const Event& event);

}  // namespace sandhopper
