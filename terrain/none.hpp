#pragma once
#include <limits>

namespace sandhopper {

inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();  // a result that does not exist

}  // namespace sandhopper
