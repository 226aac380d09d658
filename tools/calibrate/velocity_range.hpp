#pragma once
#include <vector>

#include "tools/calibrate/outcome.hpp"
#include "tools/calibrate/recording.hpp"

namespace sandhopper::calibrate {

// A drive's reported velocity v against the slope of its position, from recordings in which the leg is moved
// by hand, without torque. Over stretches of 50 ms in which the leg moves,
//   s = least-squares slope of position over time,  ratio = sum(mean(v) s) / sum(s^2)  of each recording.
struct SpeedRatio {
  double value = 0.0;  // mean over the recordings; 1 where the drive's range is the configured one
  double ci95 = 0.0;   // half-width: Student's t over the recordings, and 2 % for the drive's speed filter
  std::vector<double> of_recording{};
};

// Sets `refusals`: too_few_points (fewer than three recordings), moved_too_little, interval_too_wide, and
// velocity_range_wrong where the interval does not hold 1 (some firmware has half the manual's
// velocity range).
SpeedRatio check_velocity_range(const std::vector<Recording>& moved, std::size_t motor,
                                const CubeMarsConfig& config, std::vector<Refusal>& refusals);

}  // namespace sandhopper::calibrate
