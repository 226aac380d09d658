#pragma once
#include <vector>

#include "tools/calibrate/outcome.hpp"
#include "tools/calibrate/recording.hpp"

namespace sandhopper::calibrate {

// Ratio of a drive's reported velocity v to the slope of its position, from recordings in which the leg is
// moved by hand without torque. For each recording, over stretches of 50 ms in which the leg moves, with s
// the least-squares slope of position over time:
//   ratio = sum(mean(v) s) / sum(s^2).
struct SpeedRatio {
  double value = 0.0;  // mean over the recordings; 1 if the drive's range is the configured one
  double ci95 = 0.0;   // half-width: Student's t over the recordings, and 2 % (in quadrature) for the drive's
                       // speed filter
  std::vector<double> of_recording{};
};

// Refusals: too_few_points (fewer than three recordings); moved_too_little; interval_too_wide;
// velocity_range_wrong (the interval does not include 1; some firmware has half the manual's velocity range).
SpeedRatio check_velocity_range(const std::vector<Recording>& moved, std::size_t motor,
                                const CubeMarsConfig& config, std::vector<Refusal>& refusals);

}  // namespace sandhopper::calibrate
