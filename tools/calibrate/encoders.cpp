#include "tools/calibrate/encoders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "terrain/trial_statistics.hpp"
#include "tools/calibrate/velocity_range.hpp"

namespace sandhopper::calibrate {
namespace {

constexpr double kWander_rad = 0.003;      // allowed drift within a pose, beyond noise
constexpr double kLeastMove_rad = 0.1;     // least move that determines the sign
constexpr double kSidesDiffer_rad = 0.05;  // largest difference between the moves of the two sides

// Angles of one motor in all pairs, in the drive's own direction.
struct Side {
  std::string name;
  std::vector<double> known_rad, moved_rad;
};

// Position of the drive divided by the gear ratio, rad.
double drive_angle_rad(double link_rad, const CubeMarsConfig& motor) {
  return motor.sign * (link_rad - motor.zero_offset_rad);
}

double resolution_rad(const CubeMarsConfig& motor) {
  return 2.0 * motor.position_range_rad / 65535.0 / motor.gear_ratio;
}

double pose_rad(const Recording& recording, std::size_t index, const CubeMarsConfig& motor,
                std::vector<Refusal>& refusals) {
  const auto& samples = recording.motor[index];
  const auto series =
      series_of(samples, [&](const auto& s) { return drive_angle_rad(s.position_rad, motor); });
  const double end = 0.999 * motor.position_range_rad / motor.gear_ratio;
  if (std::ranges::any_of(series.value, [&](double v) { return std::abs(v) > end; }))
    refusals.push_back({"saturated",
                        fmt::format("{}, motor {}: the drive's position is at the end of its {:.1f} rad",
                                    recording.name, motor.name, motor.position_range_rad),
                        "set the drive's zero near the middle of its range, or correct position_range_rad"});
  // A still encoder may repeat the same count. A stuck encoder is found later, because it does not move.
  std::vector<Refusal> found;
  const auto mean = still_mean(series, {.max_wander = kWander_rad},
                               fmt::format("{}, motor {}, angle in rad", recording.name, motor.name), found);
  std::ranges::copy_if(found, std::back_inserter(refusals),
                       [](const auto& r) { return r.reason != "stuck"; });
  return mean.value;
}

Side measure(const std::vector<PosePair>& pairs, std::size_t index, const CubeMarsConfig& motor,
             std::vector<Refusal>& refusals) {
  Side out{.name = motor.name, .known_rad = {}, .moved_rad = {}};
  for (const auto& pair : pairs) {
    out.known_rad.push_back(pose_rad(pair.known, index, motor, refusals));
    out.moved_rad.push_back(pose_rad(pair.shortened, index, motor, refusals) - out.known_rad.back());
  }
  return out;
}

void check_moves(const std::vector<Side>& sides, std::vector<Refusal>& refusals) {
  for (const auto& side : sides) {
    const auto [low, high] = std::ranges::minmax(side.moved_rad);
    const double least = std::ranges::min(std::vector{std::abs(low), std::abs(high)});
    if (low < 0.0 && high > 0.0)
      refusals.push_back({"repeats_disagree",
                          fmt::format("motor {} moved by {:+.3f} to {:+.3f} rad: once this way, once that",
                                      side.name, low, high),
                          "shorten the leg every time, from the known pose"});
    else if (least < kLeastMove_rad)
      refusals.push_back(
          {"moved_too_little",
           fmt::format("motor {} moved by {:.3f} rad, at least {} rad are needed", side.name, least,
                       kLeastMove_rad),
           "shorten the leg by 3 cm or more and hold it there; if it was, the encoder is stuck or the "
           "motor slips"});
  }
  if (sides.size() < 2) return;
  for (std::size_t i = 0; i < sides[0].moved_rad.size(); ++i) {
    const double difference = std::abs(std::abs(sides[0].moved_rad[i]) - std::abs(sides[1].moved_rad[i]));
    if (difference <= kSidesDiffer_rad) continue;
    refusals.push_back({"sides_disagree",
                        fmt::format("pair {}: the two sides moved by {:.3f} and {:.3f} rad", i + 1,
                                    sides[0].moved_rad[i], sides[1].moved_rad[i]),
                        "tighten both links on their motors, see that gear_ratio is right, and repeat"});
    return;
  }
}

struct Zero {
  int sign;
  double value_rad, ci95_rad, scatter_rad;
  std::vector<double> residual_rad;
};
Zero zero_of(const Side& side, const CubeMarsConfig& motor, double angle_rad, double angle_accuracy_rad) {
  const int sign = side.moved_rad.front() > 0.0 ? 1 : -1;
  std::vector<double> zeros;
  for (const double known : side.known_rad) zeros.push_back(angle_rad - sign * known);
  const auto mean = mean_over_trials(zeros);
  const double scatter = std::max(mean.standard_deviation, resolution_rad(motor) / std::sqrt(12.0));
  const double half = student_t95(zeros.size() - 1) * scatter / std::sqrt(static_cast<double>(zeros.size()));
  Zero out{sign, mean.value, std::hypot(half, angle_accuracy_rad), mean.standard_deviation, {}};
  for (const double zero : zeros) out.residual_rad.push_back(zero - mean.value);
  return out;
}

StudySection section_of(const std::vector<Side>& sides, const std::vector<Zero>& zeros) {
  StudySection section{.title = "Pairs of poses"};
  StudyFigure figure{
      .title = "Zero of each pair less the mean", .x_label = "pair", .y_label = "zero less its mean, rad"};
  StudyTable table{.title = "Moves",
                   .columns = {"motor", "pair", "drive in the known pose, rad", "moved by, rad"}};
  for (std::size_t i = 0; i < sides.size(); ++i) {
    StudySeries series{
        .label = sides[i].name, .y = zeros[i].residual_rad, .color = i == 0 ? "blue" : "orange"};
    for (std::size_t k = 0; k < sides[i].known_rad.size(); ++k) {
      series.x.push_back(static_cast<double>(k + 1));
      table.rows.push_back({sides[i].name, std::to_string(k + 1),
                            fmt::format("{:.4f}", sides[i].known_rad[k]),
                            fmt::format("{:+.4f}", sides[i].moved_rad[k])});
    }
    figure.series.push_back(series);
  }
  section.items = {figure, table};
  return section;
}

StudySection section_of(const std::vector<Side>& sides, const std::vector<SpeedRatio>& speeds) {
  StudySection section{.title = "The leg moved by hand"};
  StudyTable table{.title = "Reported velocity over the slope of position; 1 where the ranges are right",
                   .columns = {"motor", "recording", "ratio"}};
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const auto& speed = speeds[i];
    for (std::size_t k = 0; k < speed.of_recording.size(); ++k)
      table.rows.push_back(
          {sides[i].name, std::to_string(k + 1), fmt::format("{:.4f}", speed.of_recording[k])});
    table.rows.push_back({sides[i].name, "mean", fmt::format("{:.4f} ± {:.4f}", speed.value, speed.ci95)});
  }
  section.items = {table};
  return section;
}

}  // namespace

Outcome calibrate_encoders(const EncoderRecordings& recordings, const MotorConfigs& before, const Leg& leg,
                           const EncoderSetup& setup) {
  const auto& pairs = recordings.pairs;
  Outcome out{.points = pairs.size(), .residual_unit = "rad"};
  if (pairs.size() < 3) {
    out.refusals.push_back({"too_few_points",
                            fmt::format("{} pairs of poses, at least 3 are needed", pairs.size()),
                            "repeat: known pose, shortened, known pose, shortened, …"});
    return out;
  }
  std::vector<Side> sides;
  for (std::size_t i = 0; i < static_cast<std::size_t>(leg.parameters().motor_count); ++i)
    sides.push_back(measure(pairs, i, before[i], out.refusals));
  std::vector<SpeedRatio> speeds;
  for (std::size_t i = 0; i < sides.size(); ++i)
    speeds.push_back(check_velocity_range(recordings.moved, i, before[i], out.refusals));
  if (out.refusals.empty()) check_moves(sides, out.refusals);
  if (!out.refusals.empty()) return out;
  const double angle_rad = leg.angle_at_length(setup.known_length_m);
  const double accuracy_rad = setup.length_accuracy_m / std::abs(leg.kinematics(angle_rad).dlength_m_per_rad);
  std::vector<Zero> zeros;
  Outcome::Target target{ConfigFile::robot, "encoders", {}};
  double squares = 0.0;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const auto zero = zero_of(sides[i], before[i], angle_rad, accuracy_rad);
    const auto key = fmt::format("motor[{}].", i);
    target.values.push_back({.key = key + "zero_offset_rad",
                             .unit = "rad",
                             .before = before[i].zero_offset_rad,
                             .after = zero.value_rad,
                             .ci95 = zero.ci95_rad});
    target.values.push_back(
        {.key = key + "sign", .before = 1.0 * before[i].sign, .after = 1.0 * zero.sign, .whole = true});
    squares += zero.scatter_rad * zero.scatter_rad / static_cast<double>(sides.size());
    if (zero.ci95_rad > setup.max_ci95_rad)
      out.refusals.push_back(
          {"interval_too_wide",
           fmt::format("the zero of motor {} is known to {:.4f} rad only, {} are asked for", sides[i].name,
                       zero.ci95_rad, setup.max_ci95_rad),
           "put the leg into the known pose more exactly, against a stop or a gauge, and repeat"});
    zeros.push_back(zero);
  }
  out.residual_rms = std::sqrt(squares);
  out.targets = {target};
  out.sections = {section_of(sides, zeros), section_of(sides, speeds)};
  return out;
}

}  // namespace sandhopper::calibrate
