#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/calibrate/outcome.hpp"
#include "tools/calibrate/recording.hpp"

namespace sandhopper::calibrate {

enum class TapSensor : std::uint8_t { imu_body, imu_foot, load_cell };

// What another computer recorded of the same taps, on its own clock.
struct ForeignRecording {
  std::string name;
  Series signal;
};

struct TimingSetup {
  TapSensor reference = TapSensor::imu_foot;  // whose stamps are right
  std::vector<TapSensor> others;              // the latency of which is found
  std::optional<ForeignRecording> foreign{};
  double max_ci95_s = 1e-4;
  double max_foreign_ci95_s = 1e-3;
};

// How the other computer's clock stands to the recording's: t_recording = t_foreign + offset_s + drift
// (t_foreign
// - middle_s), with the recording's time as in `hop export`, from its first cycle.
struct ForeignClock {
  double offset_s = 0.0;
  double ci95_s = 0.0;
  double drift = 0.0;
  double middle_s = 0.0;
};

// Skew between sensors from taps that all of them feel: the delay of every tap (taps.hpp), mean over the taps
// with Student's t (and 10 us for taking the reference between its samples), and latency' = latency + delay.
// What a sensor's own filter delays is part of it: the values belong to the configured rates and filters.
// `clock` is set if there is a foreign recording.
//
// Refused: fewer than five taps (too_few_points), a tap right after another (double_tap), a sensor at its end
// (saturated), a signal that does not have the reference's shape (residual_too_large), a foreign recording
// with other taps (taps_differ) or whose clock is set in between (clock_steps), delays that scatter
// (interval_too_wide), a latency below zero (negative_latency).
Outcome calibrate_timing(const Recording& taps, const LinuxBoardConfig& board, const TimingSetup& setup,
                         std::optional<ForeignClock>& clock);

}  // namespace sandhopper::calibrate
