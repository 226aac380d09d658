#pragma once
#include <string>

#include "firmware/event.hpp"

namespace sandhopper {

// For the operator, of an event arming_refused with the reason drives_not_confirmed: which motor did not make
// the commanded torque, and what to do. Empty for every other event.
std::string refusal_text(const Event& event);

}  // namespace sandhopper
