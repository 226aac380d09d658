#pragma once
#include <string>

#include "firmware/event.hpp"

namespace sandhopper {

// Message to the operator for an event arming_refused with the reason drives_not_confirmed: which motor did
// not produce the commanded torque, and the cure. Empty for every other event.
std::string refusal_text(const Event& event);

}  // namespace sandhopper
