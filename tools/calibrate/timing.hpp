#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/calibrate/outcome.hpp"
#include "tools/calibrate/recording.hpp"

namespace sandhopper::calibrate {

enum class TapSensor : std::uint8_t { imu_body, imu_foot, load_cell };

// Another computer's recording of the same taps, on its own clock.
struct ForeignRecording {
  std::string name;
  Series signal;
};

// Sensors to compare, and the widest accepted intervals.
struct TimingSetup {
  TapSensor reference = TapSensor::imu_foot;  // sensor whose time stamps are taken as correct
  std::vector<TapSensor> others;              // sensors whose latency is to be found
  std::optional<ForeignRecording> foreign{};
  double max_ci95_s = 1e-4;
  double max_foreign_ci95_s = 1e-3;
};

// Clock of the other computer: t_recording = t_foreign + offset_s + drift (t_foreign - middle_s). t_recording
// counts from the recording's first cycle, as in `hop export`.
struct ForeignClock {
  double offset_s = 0.0;
  double ci95_s = 0.0;
  double drift = 0.0;
  double middle_s = 0.0;
};

// Latency of sensors from taps that all of them measure: the delay of every tap (taps.hpp), its mean with
// Student's t, and 10 us for interpolating the reference. Then latency' = latency + delay. The delay of a
// sensor's own filter is included, so the result holds for the configured rates and filters. `clock` is set
// if there is a foreign recording.
//
// Refusals: too_few_points (fewer than five taps); double_tap; saturated (a sensor at its end);
// residual_too_large (a signal that differs from the reference in shape); taps_differ (the foreign recording
// has other taps); time_unit (they fit if the foreign times are in another unit); alignment_ambiguous (evenly
// spaced taps fit at several offsets); clock_steps (the foreign clock was set meanwhile); interval_too_wide
// (the delays scatter); negative_latency.
Outcome calibrate_timing(const Recording& taps, const LinuxBoardConfig& board, const TimingSetup& setup,
                         std::optional<ForeignClock>& clock);

}  // namespace sandhopper::calibrate
