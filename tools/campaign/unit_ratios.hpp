#pragma once
#include <array>

namespace sandhopper {

// Ratios of two units of length: m, cm, mm, inch and foot.
inline constexpr std::array kLengthRatios{1e3,  1e-3,       100.0,        0.01,        10.0,
                                          0.1,  0.0254,     1.0 / 0.0254, 2.54,        1.0 / 2.54,
                                          25.4, 1.0 / 25.4, 0.3048,       1.0 / 0.3048};
// Further ratios of two units of speed: per minute, km/h.
inline constexpr std::array kRateRatios{60.0, 1.0 / 60.0, 3.6, 1.0 / 3.6};

}  // namespace sandhopper
