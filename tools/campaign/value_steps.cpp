#include "tools/campaign/value_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "tools/campaign/column_checks.hpp"
#include "tools/campaign/implausible.hpp"

namespace sandhopper {
namespace {

constexpr std::size_t kFewestRows = 100;

struct Sample {
  double t_s, value;
  std::size_t row;
};

std::vector<Sample> samples_of(const TrialRecording& recording, std::string_view channel) {
  const auto values = recording.channel(channel);
  std::vector<Sample> samples;
  for (std::size_t row = 0; row < values.size(); ++row)
    if (!std::isnan(values[row])) samples.push_back({recording.t_s[row], values[row], row});
  return samples;
}

// The row after the only large step; 0 without one.
std::size_t only_jump(const std::vector<Sample>& samples) {
  constexpr double kTimes = 10.0, kGap = 2.5;
  std::size_t at = 0;
  double largest = 0.0, next = 0.0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double step = std::abs(samples[i].value - samples[i - 1].value);
    if (step > largest)
      next = largest, largest = step, at = i;
    else
      next = std::max(next, step);
  }
  // A glitch jumps back, a gap hides a motion, and what rests on both sides may have moved between two
  // samples.
  if (at < 2 || at + 2 >= samples.size() || !(largest > kTimes * next) || !(next > 0.0)) return 0;
  const double usual_s = (samples.back().t_s - samples.front().t_s) / static_cast<double>(samples.size() - 1);
  const auto moves = [&](std::size_t i) { return samples[i].value != samples[i - 1].value; };
  const bool in_motion = moves(at - 1) && moves(at + 1);
  return in_motion && samples[at].t_s - samples[at - 1].t_s < kGap * usual_s ? at : 0;
}

void check_jump(TrialRecording& recording, const RecordingPlaces& places, std::string_view channel) {
  const auto samples = samples_of(recording, channel);
  if (samples.size() < kFewestRows) return;
  const auto at = only_jump(samples);
  if (at == 0) return;
  const auto line = places.line_of(samples[at].row);
  doubt_column(
      recording, places, places.is_stated(channel), channel,
      fmt::format("jumps by {:.4g} in line {} and goes on from there, ten times farther than in any "
                  "other row: its zero was set anew, or another recording begins",
                  samples[at].value - samples[at - 1].value, line),
      fmt::format("give each part a [[trial]], select = {{ to_line = {} }} and select = {{ from_line = "
                  "{} }}",
                  places.line_of(samples[at - 1].row), line));
}

void check_resolution(TrialRecording& recording, const RecordingPlaces& places, std::string_view channel) {
  constexpr std::size_t kMostValues = 10;
  const auto samples = samples_of(recording, channel);
  if (samples.size() < kFewestRows) return;
  std::set<double> values;
  for (const auto& sample : samples) {
    values.insert(sample.value);
    if (values.size() > kMostValues) return;
  }
  if (values.size() < 3) return;  // at rest, or two states
  add_implausible(
      recording, places, FindingSeverity::note, channel,
      fmt::format("takes only {} different values in {} samples, {:.3g} apart: its numbers have too "
                  "few digits, or the sensor is too coarse",
                  values.size(), samples.size(),
                  (*values.rbegin() - *values.begin()) / static_cast<double>(values.size() - 1)),
      "export it with more digits");
}

// A speed whose counter is full jumps by all that it can count.
void check_full_speed(TrialRecording& recording, const RecordingPlaces& places, std::string_view channel) {
  const auto measured = recording.channel(channel);
  std::vector<double> values(measured.begin(), measured.end());
  const auto counter = put_counter_back(values);
  constexpr std::size_t kFewestJumps = 3;  // a sensor that drops out once jumps away and back
  if (counter.count < kFewestJumps) return;
  doubt_column(
      recording, places, places.is_stated(channel), channel,
      fmt::format("jumps by {:.4g} {} times while it goes on, as a counter does that is full and begins "
                  "again",
                  counter.width, counter.count),
      "record it with more bits, or rename the column: a speed is not needed beside a position");
}

}  // namespace

void check_value_steps(TrialRecording& recording, const RecordingPlaces& places) {
  constexpr std::array<std::string_view, 5> kPositions{"position_rad", "foot_z_m", "height_m",
                                                       "motor_left_position_rad", "motor_right_position_rad"};
  constexpr std::array<std::string_view, 6> kMeasured{"force_N",    "foot_z_m",          "height_m",
                                                      "accel_mps2", "load_cell_force_N", "pressure_Pa"};
  if (recording.has_time)
    for (const auto channel : kPositions)
      if (recording.has(channel)) check_jump(recording, places, channel);
  constexpr std::array<std::string_view, 4> kSpeeds{
      "velocity_radps", "foot_velocity_mps", "motor_left_velocity_radps", "motor_right_velocity_radps"};
  for (const auto channel : kSpeeds)
    if (recording.has(channel)) check_full_speed(recording, places, channel);
  for (const auto channel : kMeasured)
    if (recording.has(channel)) check_resolution(recording, places, channel);
}

}  // namespace sandhopper
