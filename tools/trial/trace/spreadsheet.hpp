#pragma once
#include <string_view>

namespace sandhopper::trace {

// True if the data of a frame are a number in scientific form, "0.00E+76" or "1.80007E+14", as a spreadsheet
// makes it from hexadecimal digits.
bool has_spreadsheet_number(std::string_view line);

}  // namespace sandhopper::trace
