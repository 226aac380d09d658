#pragma once
#include <cstdint>
#include <vector>

#include "tools/trial/trace/trace_report.hpp"

// The replies of one motor and the resolution of their fields.
namespace sandhopper::trace {

// A travel of so many steps of the position is known to 5 %: rounding of its first and last value.
inline constexpr double kTravelSteps = 20.0;
// A velocity range wrong by a factor of two is still compared. A larger step is a wrap or a jump of the
// position.
inline constexpr double kFastest = 2.0;
// Times of replies that an adapter delivers late count with the usual step; a longer pause hides the motion.
inline constexpr std::int64_t kLongestStep = 3;
// With more parts of a trace Student's t hardly falls, with fewer it rises fast.
inline constexpr std::size_t kParts = 10;
// Published ranges differ by a fifth or more (tools/calibrate/velocity_range.cpp). The limit lies halfway
// between the right range and the nearest wrong one.
inline constexpr double kDifferent = 0.1;

// In the order of the times.
std::vector<const TimedReading*> replies_of(const std::vector<TimedReading>& decoded, Side side);

// Steps of the reply's fields, at the drive's output.
double position_step_rad(const CubeMarsConfig& motor);
double velocity_step_radps(const CubeMarsConfig& motor);
double torque_step_Nm(const CubeMarsConfig& motor);  // MIT dialect

// Mean time between replies, without steps of the clock backward. An adapter that delivers in batches makes
// the median too short.
double mean_period_s(const std::vector<const TimedReading*>& replies);
double fastest_radps(const std::vector<const TimedReading*>& replies);  // largest |speed|

// Smallest speed whose rounding is below 5 %. Below it a drive may be at rest.
double least_speed_radps(const CubeMarsConfig& motor);

// Variance of the noise in a mean of two neighbouring speeds of the replies `first` to `last`. Second
// differences remove smooth motion.
double speed_noise(const std::vector<const TimedReading*>& replies, std::size_t first, std::size_t last);

}  // namespace sandhopper::trace
