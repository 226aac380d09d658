#include "tools/campaign/lost_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "tools/campaign/implausible.hpp"
#include "tools/campaign/signal_noise.hpp"

namespace sandhopper {
namespace {

constexpr std::size_t kStepsBeside = 3;  // on each side; they give the usual step and its change
constexpr double kJumpClear = 5.0;       // in standard deviations
constexpr double kByChance = 0.01;

// True if all steps of the time are equal within the digits that it is written with.
bool grows_evenly(const std::vector<double>& t_s) {
  if (t_s.size() < 4 * kStepsBeside) return false;
  const double step_s = (t_s.back() - t_s.front()) / static_cast<double>(t_s.size() - 1);
  constexpr double kRounded = 0.01;  // A time with two digits for each step; a clock's jitter is larger.
  for (std::size_t i = 1; i < t_s.size(); ++i)
    if (std::abs(t_s[i] - t_s[i - 1] - step_s) > kRounded * step_s) return false;
  return step_s > 0.0;
}

// The samples of a channel. No steps if their rows do not come evenly.
struct EvenSamples {
  explicit EvenSamples(std::span<const double> channel) {
    for (std::size_t row = 0; row < channel.size(); ++row)
      if (!std::isnan(channel[row])) rows.push_back(row), values.push_back(channel[row]);
    for (std::size_t i = 2; i < rows.size(); ++i)
      if (rows[i] - rows[i - 1] != rows[1] - rows[0]) return;
    for (std::size_t i = 1; i < values.size(); ++i) steps.push_back(values[i] - values[i - 1]);
  }

  std::vector<std::size_t> rows;
  std::vector<double> values, steps;  // steps[i] leads from sample i to sample i + 1
};

struct FrameJump {
  std::size_t row = 0;  // first row after the lost frames
  double across = 0.0;  // step to this row
  double frames = 0.0;  // lost
  double off = 0.0;     // Distance of the step from a whole number of usual ones, at most 1/2.
};

// The usual step at `at`: the mean of both sides, which is right for a constant acceleration, too. Empty if
// the sides are not even within a fifth.
std::optional<double> usual_step(const EvenSamples& samples, std::size_t at) {
  constexpr double kEven = 0.2, kBeside = static_cast<double>(kStepsBeside);
  const auto& x = samples.values;
  const double before = (x[at] - x[at - kStepsBeside]) / kBeside;
  const double after = (x[at + 1 + kStepsBeside] - x[at + 1]) / kBeside;
  const double step = 0.5 * (before + after);
  if (!(before * after > 0.0) || !(std::abs(before - after) < kEven * std::abs(step))) return std::nullopt;
  return step;
}

// A step that the usual one and the noise do not explain, and that is not made up for by the next step, as a
// late sample would be.
std::optional<FrameJump> jump_at(const EvenSamples& samples, std::size_t at, double step, double noise) {
  const auto& steps = samples.steps;
  const double times = steps[at] / step;
  if (!(times > 1.5) || !(std::abs(steps[at] - step) > kJumpClear * noise)) return std::nullopt;
  if (!(steps[at + 1] / step > 0.5)) return std::nullopt;
  return FrameJump{samples.rows[at + 1], steps[at], std::round(times) - 1.0,
                   std::abs(times - std::round(times))};
}

struct LostFrames {
  std::vector<FrameJump> jumps;
  std::size_t repeated = 0;  // samples that were read twice
};

// True if a sample stands still between moving ones: it was read twice.
bool is_repeated(const EvenSamples& samples, std::size_t at, double step, double noise) {
  return std::abs(samples.steps[at] / step) < 0.5 && std::abs(samples.steps[at] - step) > kJumpClear * noise;
}

// True if the samples may only be late: a recorder that reads them in its own time skips some and reads
// others twice, each as often as the other.
bool are_late(std::size_t skipped, std::size_t repeated) {
  if (repeated == 0) return false;
  const boost::math::binomial equal(static_cast<double>(skipped + repeated), 0.5);
  return boost::math::cdf(boost::math::complement(equal, static_cast<double>(skipped) - 1.0)) > kByChance;
}

// Empty if the samples may only be late, if the jumps are no whole numbers of steps, as those of a foot that
// sticks and slips, or if they may be that by chance: n numbers are all within `off` of a whole one with the
// probability (2 off)^n.
LostFrames lost_frames(std::span<const double> channel) {
  constexpr std::size_t kFewestJumps = 3;  // one or two may be an impact or a slip
  const EvenSamples samples(channel);
  LostFrames lost;
  auto& [jumps, repeated] = lost;
  if (samples.steps.size() < 4 * kStepsBeside) return lost;
  // Steps of an encoder differ by its own step: 1, 1, 2, 1, 1 are no lost frames.
  const double noise = std::max(std::sqrt(2.0) * noise_of_bends(samples.values), digit_of(samples.steps));
  double off = 0.0;
  for (std::size_t at = kStepsBeside; at + kStepsBeside < samples.steps.size(); ++at) {
    const auto step = usual_step(samples, at);
    if (!step) continue;
    if (is_repeated(samples, at, *step, noise)) ++repeated;
    if (const auto jump = jump_at(samples, at, *step, noise))
      jumps.push_back(*jump), off = std::max(off, jump->off);
  }
  const bool by_chance = std::pow(2.0 * off, static_cast<double>(jumps.size())) > kByChance;
  if (jumps.size() < kFewestJumps || by_chance || are_late(jumps.size(), repeated)) jumps.clear();
  return lost;
}

// Rows of the longest stretch without a jump.
std::pair<std::size_t, std::size_t> longest_stretch(const std::vector<FrameJump>& jumps, std::size_t rows) {
  std::pair<std::size_t, std::size_t> best{0, jumps.front().row - 1};
  for (std::size_t i = 0; i < jumps.size(); ++i) {
    const std::size_t last = i + 1 < jumps.size() ? jumps[i + 1].row - 1 : rows - 1;
    if (last - jumps[i].row > best.second - best.first) best = {jumps[i].row, last};
  }
  return best;
}

void doubt_frames(TrialRecording& recording, const RecordingPlaces& places, std::string_view channel,
                  const LostFrames& lost) {
  const auto& jumps = lost.jumps;
  double frames = -static_cast<double>(lost.repeated);
  for (const auto& jump : jumps) frames += jump.frames;
  const auto [first, last] = longest_stretch(jumps, recording.rows());
  const auto& most =
      *std::ranges::max_element(jumps, {}, [](const FrameJump& j) { return std::abs(j.across); });
  doubt_column(
      recording, places, places.is_stated("t_s"), "t_s",
      fmt::format(
          "grows evenly, but {} changes by {:.3g} up to line {}, {:.0f} times the step of the rows beside "
          "it. {} rows have such a step: {:.0f} frames or more are missing, and the time was made from "
          "the row number",
          channel, most.across, places.line_of(most.row), most.frames + 1.0, jumps.size(), frames),
      fmt::format(
          "write the camera's or logger's own times, or frame numbers that count the missing ones; or "
          "take the longest stretch without a loss: select = {{ from_line = {}, to_line = {} }}; if the "
          "position really jumps, state unit and scale of t_s",
          places.line_of(first), places.line_of(last)));
}

}  // namespace

void check_lost_frames(TrialRecording& recording, const RecordingPlaces& places) {
  constexpr std::array<std::string_view, 7> kPositions{
      "position_rad",   "foot_z_m",      "height_m", "motor_left_position_rad", "motor_right_position_rad",
      "mocap_body_z_m", "mocap_foot_z_m"};
  if (!recording.has_time || !grows_evenly(recording.t_s)) return;
  for (const auto channel : kPositions) {
    if (!recording.has(channel)) continue;
    const auto lost = lost_frames(recording.channel(channel));
    if (!lost.jumps.empty()) return doubt_frames(recording, places, channel, lost);
  }
}

}  // namespace sandhopper
