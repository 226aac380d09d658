#include "tools/campaign/free_swing_check.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/campaign/implausible.hpp"
#include "tools/campaign/signal_noise.hpp"

namespace sandhopper {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
constexpr double kDegree_rad = std::numbers::pi / 180.0;

// The median of every five samples: a reading that failed once or twice is no motion.
std::vector<double> without_spikes(std::span<const double> values) {
  std::vector<double> fresh, out;
  std::ranges::copy_if(values, std::back_inserter(fresh), [](double value) { return !std::isnan(value); });
  for (std::size_t i = 0; i + 5 <= fresh.size(); ++i) {
    std::array<double, 5> five{};
    std::copy_n(fresh.begin() + static_cast<std::ptrdiff_t>(i), 5, five.begin());
    std::ranges::nth_element(five, five.begin() + 2);
    out.push_back(five[2]);
  }
  return out;
}

// The way in one direction that is followed by the same way or more in the other.
double way_there_and_back(const std::vector<double>& angles) {
  double low = angles.front(), high = angles.front();  // of all before
  double rise = 0.0, fall = 0.0;                       // largest so far
  double best = 0.0;
  // After a rise, the fall from the highest angle; after a fall, the rise from the lowest.
  double top_after_low = -std::numeric_limits<double>::infinity(), low_after_top = -top_after_low;
  for (const double angle : angles) {
    low = std::min(low, angle), high = std::max(high, angle);
    if (angle - low >= rise) rise = angle - low, top_after_low = angle;
    if (high - angle >= fall) fall = high - angle, low_after_top = angle;
    best = std::max({best, std::min(rise, top_after_low - angle), std::min(fall, angle - low_after_top)});
  }
  return best;
}

bool swings_free(const TrialRecording& recording, const CampaignTrial& trial) {
  if (const auto enabled = trial.flag("motor_enabled")) return !*enabled;
  const bool has_torque = recording.has("torque_Nm") ||
                          std::ranges::find(recording.at_one_value, "torque_Nm",
                                            &TrialRecording::Channel::name) != recording.at_one_value.end();
  return !has_torque && trial.text("profile").value_or("release") == "release";
}

// True if the axis starts with less than a hundredth of its largest kinetic energy, farther from upright than
// that energy lifts it: the slope at the first sample of a parabola through the first ten is less than a
// tenth of the largest speed, by five of its standard deviations.
bool starts_at_rest(std::span<const double> t_s, std::span<const double> angles) {
  constexpr Eigen::Index kFirst = 10;
  constexpr double kClear = 5.0, kSlow = 0.1;
  double fastest = 0.0;
  for (std::size_t i = 1; i < angles.size(); ++i)
    if (const double speed = (angles[i] - angles[i - 1]) / (t_s[i] - t_s[i - 1]); !std::isnan(speed))
      fastest = std::max(fastest, std::abs(speed));
  if (static_cast<Eigen::Index>(angles.size()) < kFirst) return false;
  const Eigen::ArrayXd t = Eigen::Map<const Eigen::ArrayXd>(t_s.data(), kFirst) - t_s.front();
  const Eigen::VectorXd y = Eigen::Map<const Eigen::VectorXd>(angles.data(), kFirst);
  Eigen::MatrixXd by(kFirst, 3);
  by << Eigen::VectorXd::Ones(kFirst), t.matrix(), t.square().matrix();
  const Eigen::MatrixXd inverse = (by.transpose() * by).inverse();
  const Eigen::VectorXd fitted = inverse * by.transpose() * y;
  const double variance = (y - by * fitted).squaredNorm() / static_cast<double>(kFirst - 3);
  const double error = kClear * std::sqrt(variance * inverse(1, 1));
  const bool is_near_upright = std::cos(angles.front()) <= 2.0 * kSlow * kSlow - 1.0;
  return std::abs(fitted[1]) + error <= kSlow * fastest && !is_near_upright;
}

// The way of an angle that never comes back by more than its noise; 0 if it does.
double way_without_return(const std::vector<double>& angles, double noise_rad) {
  constexpr double kClear = 5.0;  // in standard deviations
  double low = angles.front(), high = angles.front(), back_of_rise = 0.0, back_of_fall = 0.0;
  for (const double angle : angles) {
    low = std::min(low, angle), high = std::max(high, angle);
    back_of_rise = std::max(back_of_rise, high - angle);
    back_of_fall = std::max(back_of_fall, angle - low);
  }
  return std::min(back_of_rise, back_of_fall) <= kClear * noise_rad ? high - low : 0.0;
}

// The extremes of a swing: from each it comes back by `least_rad`.
std::vector<double> turning_angles(const std::vector<double>& angles, double least_rad) {
  std::vector<double> turns;
  double extreme = angles.front(), sign = 0.0;
  for (const double angle : angles) {
    if (sign == 0.0 && std::abs(angle - angles.front()) > least_rad)
      sign = std::copysign(1.0, angle - angles.front()), extreme = angle;
    if (sign == 0.0) continue;
    if (sign * (angle - extreme) > 0.0) extreme = angle;
    if (sign * (extreme - angle) < least_rad) continue;
    turns.push_back(extreme);
    extreme = angle, sign = -sign;
  }
  return turns;
}

// The angle about which a pendulum swings, from three turns that follow each other: (a + 2 b + c) / 4 is free
// of a constant loss per swing. Empty if it does not swing.
std::optional<double> middle_of_swing(const std::vector<double>& angles, double noise_rad) {
  const auto [low, high] = std::ranges::minmax(angles);
  constexpr double kShare = 0.25;  // A swing that has lost more of its width is not counted.
  constexpr double kClear = 5.0;   // in standard deviations of the noise, which is no swing
  const auto turns = turning_angles(angles, std::max(kShare * (high - low), kClear * noise_rad));
  if (turns.size() < 3 || !(high > low)) return std::nullopt;
  const auto* last = &turns[turns.size() - 3];
  return 0.25 * (last[0] + 2.0 * last[1] + last[2]);
}

struct AngleDoubt {
  std::string what;
  double factor = 1.0;      // of the column's scale, if another unit is what is wrong
  double offset_rad = 0.0;  // that moves the hanging position to 0, if the zero is what is wrong
  std::string cure{};       // in place of a line of [columns]
};

AngleDoubt doubt_of_angle(const std::vector<double>& angles, double noise_rad, const CampaignTrial& trial) {
  const auto [low, high] = std::ranges::minmax(angles);
  if (const double way = way_there_and_back(angles); way > kTurn_rad)
    return {fmt::format("turns by {:.3g} rad and back, more than one turn, and a pendulum that swings free "
                        "and turns round stays within one turn (6.28 rad): degrees taken for rad, or the "
                        "angle of a motor before its gear",
                        way),
            kDegree_rad, 0.0, ""};
  if (const auto middle = middle_of_swing(angles, noise_rad)) {
    const double quarters = std::round(*middle / (0.25 * kTurn_rad));
    if (std::fmod(quarters, 4.0) != 0.0)
      return {fmt::format("swings about {:.4g} rad, which is {} from hanging, angle 0", *middle,
                          std::fmod(quarters, 2.0) == 0.0 ? "half a turn" : "a quarter turn"),
              1.0, -quarters * 0.25 * kTurn_rad};
  }
  const double release = std::abs(trial.number("release_position_rad").value_or(0.0));
  if (!(release > 0.0)) return {};
  const double half = 0.5 * (high - low), between = std::sqrt(1.0 / kDegree_rad);
  if (half > between * release)
    return {fmt::format("swings by {:.3g} rad to either side, and release_position_rad is {:.4g}: a pendulum "
                        "that is let go swings no farther than that",
                        half, release),
            kDegree_rad, 0.0};
  constexpr double kNearRelease = 0.2;  // as kNearHeight of fall_limits.cpp: the zero, and rows that are cut
  const bool starts_small = std::abs(std::abs(angles.front()) / (release * kDegree_rad) - 1.0) < kNearRelease;
  if (starts_small && half < (1.0 + kNearRelease) * release * kDegree_rad)
    return {fmt::format("starts at {:.3g} rad, and release_position_rad is {:.4g}, {:.3g} times that",
                        angles.front(), release, release / std::abs(angles.front())),
            1.0 / kDegree_rad, 0.0};
  return {};
}

// A pendulum that is let go at rest has at most the energy of its upright position: it stays within a turn.
AngleDoubt doubt_of_direction(const std::vector<double>& angles, std::span<const double> t_s,
                              std::span<const double> position) {
  const double way = way_without_return(angles, noise_of_bends(position));
  if (!(way > kTurn_rad) || !starts_at_rest(t_s, position)) return {};
  return {
      fmt::format("goes on by {:.3g} rad from rest and never comes back, and a pendulum that is let go at "
                  "rest stays within one turn (6.28 rad): an encoder that counts in one direction only, "
                  "or an axis that is driven",
                  way),
      1.0, 0.0,
      "record both channels of the encoder, or write motor_enabled = true for a trial that is driven"};
}

}  // namespace

void check_free_swing(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                      const RecordingPlaces& places) {
  const auto* belief = std::get_if<RotaryAxisBelief>(&trial.belief);
  if (campaign.plant != CampaignPlant::rotary_axis || belief == nullptr || !recording.has_time) return;
  if (trial.kind != TrialKind::motion || !recording.has("position_rad") || any_unusable(recording.findings))
    return;
  if (!(belief->axis.gravity_torque_Nm > 0.0) || !swings_free(recording, trial)) return;
  const auto angles = without_spikes(recording.channel("position_rad"));
  if (angles.empty()) return;
  const auto position = recording.channel("position_rad");
  auto doubt = doubt_of_angle(angles, noise_of_bends(position), trial);
  if (doubt.what.empty()) doubt = doubt_of_direction(angles, recording.t_s, position);
  if (doubt.what.empty()) return;
  const auto* column = places.column_of("position_rad");
  auto corrected = column == nullptr ? UsedColumn{} : in_other_unit(*column, doubt.factor);
  corrected.offset += doubt.offset_rad;
  doubt_column(recording, places, places.is_stated("position_rad"), "position_rad", std::move(doubt.what),
               column == nullptr     ? "correct the unit of position_rad"
               : !doubt.cure.empty() ? std::move(doubt.cure)
                                     : fmt::format("if so write {} into [columns], or correct the set-up",
                                                   mapping_line(corrected)));
}

}  // namespace sandhopper
