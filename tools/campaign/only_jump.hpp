#pragma once
#include <cstddef>
#include <string_view>
#include <vector>

#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {

// A step of more than so many of the next largest one is a jump.
inline constexpr double kJumpTimes = 10.0;
// A longer step of the time, in usual steps, may hide a motion.
inline constexpr double kJumpGap = 2.5;
// With fewer samples the usual steps are not known.
inline constexpr std::size_t kFewestJumpRows = 100;

struct StepSample {
  double t_s, value;
  std::size_t row;
};

// The samples of a channel; empty if they are fewer than kFewestJumpRows.
std::vector<StepSample> step_samples(const TrialRecording& recording, std::string_view channel);

// First sample after the jump, and the last one before it if the signal jumps to and fro before it stays.
struct Jump {
  std::size_t before = 0, after = 0;
};

// The steps of which each is more than kJumpTimes of every other one, if they alternate and leave the signal
// at another level: one jump, or one that flickers. 0, 0 without one. A glitch jumps back, a gap hides a
// motion, and a signal that rests beside the jump may have moved between two samples.
Jump only_jump(const std::vector<StepSample>& samples);

}  // namespace sandhopper
