#include "tools/campaign/value_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>
#include <vector>

#include "tools/campaign/column_checks.hpp"
#include "tools/campaign/implausible.hpp"
#include "tools/campaign/only_jump.hpp"
#include "tools/campaign/signal_noise.hpp"

namespace sandhopper {
namespace {

constexpr double kLostRow = 1.5;  // as in are_lost_rows of sample_times.cpp

// True if the foot is above the surface on both sides of the jump, and no force before it is clear of the
// noise. Nothing touched the foot, so it may have been moved fast; the depth after it counts.
bool is_jump_in_air(const TrialRecording& recording, const Jump& jump,
                    const std::vector<StepSample>& samples) {
  constexpr double kForceClear = 5.0;  // in standard deviations of the noise
  if (!recording.has("foot_z_m") || !recording.has("force_N")) return false;
  if (samples[jump.before].value <= 0.0 || samples[jump.after].value <= 0.0) return false;
  std::vector<double> forces;
  for (std::size_t row = 0; row <= samples[jump.after].row; ++row)
    if (const double force = recording.channel("force_N")[row]; !std::isnan(force)) forces.push_back(force);
  if (forces.empty()) return false;
  const auto [low, high] = std::ranges::minmax(forces);
  return high - low <= 2.0 * kForceClear * noise_of_bends(forces);
}

// The mapping by which the part after the jump goes on from the part before it; empty without a column.
std::string continuing_cure(const RecordingPlaces& places, std::string_view channel, const Jump& jump,
                            const std::vector<StepSample>& samples) {
  const auto* column = places.column_of(channel);
  if (column == nullptr) return "";
  const double before = samples[jump.before].value - samples[jump.before - 1].value;
  const double after = samples[jump.after + 1].value - samples[jump.after].value;
  const double steps = static_cast<double>(jump.after - jump.before);
  auto moved = *column;
  moved.offset -= samples[jump.after].value - samples[jump.before].value - 0.5 * (before + after) * steps;
  return fmt::format(
      "; if its zero was set anew, the second needs columns = {{ {} }}, by which it goes on from the first",
      mapping_line(moved));
}

void check_jump(TrialRecording& recording, const RecordingPlaces& places, std::string_view channel) {
  const auto samples = step_samples(recording, channel);
  const auto jump = only_jump(samples);
  const auto [before, at] = jump;
  if (at == 0 || (channel == "foot_z_m" && is_jump_in_air(recording, jump, samples))) return;
  const auto line = places.line_of(samples[at].row);
  doubt_column(
      recording, places, places.is_stated(channel), channel,
      fmt::format("jumps by {:.4g} in line {} and goes on from there, ten times farther than in any "
                  "other row: its zero was set anew, or another recording begins",
                  samples[at].value - samples[before].value, line),
      fmt::format("give each part a [[trial]], select = {{ to_line = {} }} and select = {{ from_line = "
                  "{} }}{}",
                  places.line_of(samples[before].row), line,
                  continuing_cure(places, channel, jump, samples)));
}

// The row of the only step that stands out from both of its neighbours by ten times more than any other two
// steps that follow each other differ; 0 without one. A stop or a blow changes the speed, so that a step lies
// between its neighbours.
std::size_t only_slip(const std::vector<StepSample>& samples) {
  double largest = 0.0, next = 0.0;
  std::size_t at = 0;
  const auto step = [&](std::size_t i) { return samples[i].value - samples[i - 1].value; };
  for (std::size_t i = 2; i + 1 < samples.size(); ++i) {
    const double in = step(i) - step(i - 1), out = step(i) - step(i + 1);
    const double stands_out = in * out > 0.0 ? std::min(std::abs(in), std::abs(out)) : 0.0;
    if (stands_out > largest) largest = stands_out, at = i;
  }
  for (std::size_t i = 2; i < samples.size(); ++i)
    if (i != at && i != at + 1) next = std::max(next, std::abs(step(i) - step(i - 1)));
  return largest > kJumpTimes * next && next > 0.0 ? at : 0;
}

// True if the signal moves clearly within ten samples of both sides: a drive that holds its angle and then
// turns within one row slips nowhere.
bool moves_beside(const std::vector<StepSample>& samples, std::size_t at) {
  constexpr std::size_t kBeside = 10;
  constexpr double kClear = 5.0;  // in standard deviations of the noise
  if (at < kBeside || at + kBeside > samples.size()) return false;
  std::vector<double> values;
  for (const auto& sample : samples) values.push_back(sample.value);
  const double clear = kClear * noise_of_bends(values);
  const auto width = [&](std::size_t begin) {
    const auto [low, high] = std::ranges::minmax(std::span(values).subspan(begin, kBeside));
    return high - low;
  };
  return width(at - kBeside) > clear && width(at) > clear;
}

// An encoder on its shaft may slip by less than ten of its steps; its steps change by far less.
void check_slip(TrialRecording& recording, const RecordingPlaces& places, std::string_view channel) {
  const auto samples = step_samples(recording, channel);
  if (samples.empty() || only_jump(samples).after != 0) return;
  const auto at = only_slip(samples);
  if (at == 0 || !moves_beside(samples, at)) return;
  const double usual_s = (samples.back().t_s - samples.front().t_s) / static_cast<double>(samples.size() - 1);
  if (samples[at].t_s - samples[at - 1].t_s >= kLostRow * usual_s) return;
  const double usual =
      0.5 * (samples[at + 1].value - samples[at].value + samples[at - 1].value - samples[at - 2].value);
  const double slip = samples[at].value - samples[at - 1].value - usual;
  const auto line = places.line_of(samples[at].row);
  doubt_column(
      recording, places, places.is_stated(channel), channel,
      fmt::format(
          "goes {:.3g} rad farther in line {} than in the rows beside it, ten times more than its step "
          "changes in any other row: the encoder slipped on its shaft, or lost counts",
          slip, line),
      fmt::format(
          "give each part a [[trial]] with its own offset of {}, select = {{ to_line = {} }} and select "
          "= {{ from_line = {} }}",
          channel, places.line_of(samples[at - 1].row), line));
}

void check_resolution(TrialRecording& recording, const RecordingPlaces& places, std::string_view channel) {
  constexpr std::size_t kMostValues = 10;
  const auto samples = step_samples(recording, channel);
  if (samples.empty()) return;
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
  constexpr std::array<std::string_view, 3> kAngles{"position_rad", "motor_left_position_rad",
                                                    "motor_right_position_rad"};
  if (recording.has_time)
    for (const auto channel : kAngles)
      if (recording.has(channel)) check_slip(recording, places, channel);
  constexpr std::array<std::string_view, 4> kSpeeds{
      "velocity_radps", "foot_velocity_mps", "motor_left_velocity_radps", "motor_right_velocity_radps"};
  for (const auto channel : kSpeeds)
    if (recording.has(channel)) check_full_speed(recording, places, channel);
  for (const auto channel : kMeasured)
    if (recording.has(channel)) check_resolution(recording, places, channel);
}

}  // namespace sandhopper
