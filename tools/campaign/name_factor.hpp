#pragma once
#include <string_view>

namespace sandhopper {

// True if a column's name, without its unit, holds a factor: "Force x10", "10*Force", "Force/10", "F 10^1",
// "F 1e-3", or a power of the quantity, "Force^2". It does not tell whether the numbers or the unit are so
// many times as large. Not for names that hold numbers: "F10", "Force 1", "x10", "Dev1/ai0", "2023/10/12".
bool name_holds_factor(std::string_view name);

}  // namespace sandhopper
