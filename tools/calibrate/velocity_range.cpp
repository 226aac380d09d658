#include "tools/calibrate/velocity_range.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "terrain/trial_statistics.hpp"
#include "tools/calibrate/line.hpp"

namespace sandhopper::calibrate {
namespace {

constexpr double kStretch_s = 0.05;
constexpr std::size_t kStretchSamples = 4;
constexpr double kMoving_radps = 0.5;  // 20 steps of the MIT dialect's velocity
constexpr int kMovingStretches = 10;
constexpr double kSystematic = 0.02;
constexpr double kWidest = 0.15;  // widest accepted interval; wrong ranges in the field are off by a fifth or
                                  // more
constexpr double kNoSpeed = 0.05;

struct Stretch {
  double slope_radps;
  double velocity_radps;
};

Stretch measure(const MotorSample* first, std::size_t count) {
  std::vector<double> times_s, positions_rad;
  double velocity_radps = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    times_s.push_back(static_cast<double>(first[i].time_ns - first->time_ns) * 1e-9);
    positions_rad.push_back(first[i].position_rad - first->position_rad);
    velocity_radps += first[i].velocity_radps / static_cast<double>(count);
  }
  return {fit_line(times_s, positions_rad, 0.0).slope, velocity_radps};
}

// std::nullopt if the leg moved in fewer than kMovingStretches stretches.
std::optional<double> ratio_of(const std::vector<MotorSample>& samples) {
  double products = 0.0, squares = 0.0;
  int moving = 0;
  for (std::size_t begin = 0, end = 0; begin < samples.size(); begin = end) {
    while (end < samples.size() &&
           static_cast<double>(samples[end].time_ns - samples[begin].time_ns) * 1e-9 < kStretch_s)
      ++end;
    if (end - begin < kStretchSamples) continue;
    const auto stretch = measure(&samples[begin], end - begin);
    if (!(std::abs(stretch.slope_radps) > kMoving_radps)) continue;
    products += stretch.velocity_radps * stretch.slope_radps;
    squares += stretch.slope_radps * stretch.slope_radps;
    ++moving;
  }
  if (moving < kMovingStretches) return std::nullopt;
  return products / squares;
}

// Suggests the value of the drive's key that would make the ratio 1.
std::string likely(const CubeMarsConfig& motor, double ratio) {
  if (ratio < kNoSpeed) return "the drive reports hardly any speed: check its mode and firmware";
  if (motor.dialect == Dialect::mit)
    return fmt::format(
        "velocity_range_radps is {:.4g}, the drive's is likely {:.3g}: read it off the drive with CubeMars' "
        "tool and write it (if that shows the configured one, position_range_rad is wrong)",
        motor.velocity_range_radps, motor.velocity_range_radps / ratio);
  return fmt::format(
      "pole_pairs times drive_reduction is {:.4g}, of this motor it is likely {:.3g}: look both up and "
      "write them",
      motor.pole_pairs * motor.drive_reduction, motor.pole_pairs * motor.drive_reduction * ratio);
}

}  // namespace

SpeedRatio check_velocity_range(const std::vector<Recording>& moved, std::size_t motor,
                                const CubeMarsConfig& config, std::vector<Refusal>& refusals) {
  SpeedRatio out;
  if (moved.size() < 3) {
    refusals.push_back({"too_few_points",
                        fmt::format("{} recordings of a moving leg, at least 3 are needed", moved.size()),
                        "record three, the leg moved to and fro by hand"});
    return out;
  }
  for (const auto& recording : moved) {
    const auto ratio = ratio_of(recording.motor[motor]);
    if (!ratio) {
      refusals.push_back(
          {"moved_too_little",
           fmt::format("{}: motor {} turned faster than {} rad/s for less than {:.1f} s", recording.name,
                       config.name, kMoving_radps, kMovingStretches * kStretch_s),
           "move the leg to and fro by hand, once a second or faster, for the whole recording"});
      return out;
    }
    out.of_recording.push_back(*ratio);
  }
  const auto mean = mean_over_trials(out.of_recording);
  const double n = static_cast<double>(moved.size());
  out.value = mean.value;
  out.ci95 = std::hypot(student_t95(moved.size() - 1) * mean.standard_deviation / std::sqrt(n), kSystematic);
  const auto found = fmt::format("motor {} reports {:.3f} +- {:.3f} times the speed its position has",
                                 config.name, out.value, out.ci95);
  if (out.ci95 > kWidest)
    refusals.push_back({"interval_too_wide", found,
                        "move the leg evenly, without striking its ends, and repeat; check the CAN cable"});
  else if (std::abs(out.value - 1.0) > out.ci95)
    refusals.push_back({"velocity_range_wrong", found, likely(config, out.value)});
  return out;
}

}  // namespace sandhopper::calibrate
