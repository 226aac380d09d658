#include "tools/campaign/axis_torque_check.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "tools/campaign/implausible.hpp"

namespace sandhopper {
namespace {

using enum FindingSeverity;
using Row = Eigen::Matrix<double, 5, 1>;

struct Inertia {
  double value = 0.0, error = 0.0, share = 0.0;  // kg m2, its standard error, explained share of the variance
};

// Samples of an axis in the rows that hold position and torque.
struct Axis {
  std::vector<double> t_s, angle_rad, torque_Nm;

  explicit Axis(const TrialRecording& recording) {
    const auto x = recording.channel("position_rad"), torque = recording.channel("torque_Nm");
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (std::isnan(x[i]) || std::isnan(torque[i])) continue;
      t_s.push_back(recording.t_s[i]);
      angle_rad.push_back(x[i]);
      torque_Nm.push_back(torque[i]);
    }
  }
  std::size_t size() const { return t_s.size(); }
  // Mean rate of the angle over `half` rows on either side.
  double speed(std::size_t at, std::size_t half) const {
    return (angle_rad[at + half] - angle_rad[at - half]) / (t_s[at + half] - t_s[at - half]);
  }
};

std::optional<Inertia> inertia_seen(const Axis& axis) {
  constexpr std::size_t kWindows = 40, kFewestRows = 400;
  if (axis.size() < kFewestRows) return std::nullopt;
  const std::size_t length = axis.size() / kWindows, half = std::max<std::size_t>(1, length / 4);
  Eigen::Matrix<double, 5, 5> normal = Eigen::Matrix<double, 5, 5>::Zero();
  Row right = Row::Zero();
  double yy = 0.0, y_sum = 0.0, count = 0.0;
  for (std::size_t begin = half; begin + length + half < axis.size();
       begin += std::max<std::size_t>(1, length / 2)) {
    const std::size_t end = begin + length;
    double impulse = 0.0, gravity = 0.0, direction = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      const double dt = axis.t_s[i + 1] - axis.t_s[i];
      impulse += 0.5 * (axis.torque_Nm[i] + axis.torque_Nm[i + 1]) * dt;
      gravity += std::sin(axis.angle_rad[i]) * dt;
      direction += axis.angle_rad[i + 1] > axis.angle_rad[i] ? dt : -dt;
    }
    Row row;
    row << axis.speed(end, half) - axis.speed(begin, half), gravity,
        axis.angle_rad[end] - axis.angle_rad[begin], direction, axis.t_s[end] - axis.t_s[begin];
    normal += row * row.transpose();
    right += row * impulse;
    yy += impulse * impulse, y_sum += impulse, count += 1.0;
  }
  constexpr double kFewestWindows = 20.0;
  if (count < kFewestWindows) return std::nullopt;
  // Scaled to unit columns: their units differ.
  const Row scale = normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::Matrix<double, 5, 5> scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  const Eigen::Matrix<double, 5, 5> ridge = 1e-9 * Eigen::Matrix<double, 5, 5>::Identity();
  const Eigen::LDLT<Eigen::Matrix<double, 5, 5>> solver(scaled + ridge);
  const Row size = scale.asDiagonal() * solver.solve(scale.asDiagonal() * right);
  const double left = std::max(0.0, yy - 2.0 * size.dot(right) + size.dot(normal * size));
  const double variance = yy - y_sum * y_sum / count;
  if (!(variance > 0.0)) return std::nullopt;
  const Row unit = Row::Unit(0);
  const double information = unit.dot(solver.solve(unit)) * scale[0] * scale[0];
  return Inertia{size[0], std::sqrt(left / (count - 5.0) * information), 1.0 - left / variance};
}

struct UnitRatio {
  double ratio;
  std::string_view text;
  double torque_factor;  // of the torque's scale, if that is what is wrong
};
constexpr std::array kUnitRatios{
    UnitRatio{1e3, "1000: the torque in mN m, or the inertia in g m2", 1e-3},
    UnitRatio{1e-3, "0.001: the torque in kN m, or the inertia in g m2 taken for kg m2", 1e3},
    UnitRatio{100.0, "100: the torque in N cm", 0.01},
    UnitRatio{1e4, "10000: the inertia in kg cm2", 0.0},
    UnitRatio{1e-4, "0.0001: the inertia in kg cm2 taken for kg m2", 0.0},
    UnitRatio{1.0 / 9.80665, "0.102: the torque in kgf m", 9.80665},
    UnitRatio{57.29578, "57.3: the position in rad, taken for degrees", 0.0},
    UnitRatio{1.0 / 57.29578, "0.01745: the position in degrees, taken for rad", 0.0},
    UnitRatio{8.850746, "8.85: the torque in lbf in", 0.112984829}};

}  // namespace

void check_axis_torque(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                       const RecordingPlaces& places) {
  const auto* belief = std::get_if<RotaryAxisBelief>(&trial.belief);
  if (campaign.plant != CampaignPlant::rotary_axis || belief == nullptr || !recording.has_time) return;
  if (trial.kind != TrialKind::motion || !trial.flag("motor_enabled").value_or(true)) return;
  if (!recording.has("position_rad") || !recording.has("torque_Nm") || any_unusable(recording.findings))
    return;
  const double believed = belief->axis.inertia_kg_m2;
  const bool is_default = believed == RotaryAxisBelief{}.axis.inertia_kg_m2;
  if (!(believed > 0.0) || is_default || trial.is_unstated("axis.inertia_kg_m2")) return;
  const auto seen = inertia_seen(Axis(recording));
  if (!seen || seen->share < 0.8 || std::abs(seen->value) < 20.0 * seen->error) return;
  const double ratio = seen->value / believed;
  if (ratio > 0.2 && ratio < 5.0) return;
  // Another effect that the belief lacks shifts the inertia that is seen.
  constexpr double kShift = 1.3, kFarTooHeavy = 20.0;
  const auto off = [&](const UnitRatio& unit) { return std::abs(std::log(std::abs(ratio) / unit.ratio)); };
  const auto& known = *std::ranges::min_element(kUnitRatios, {}, off);
  const bool is_unit = off(known) < std::log(kShift), other_sign = ratio < 0.0;
  std::string cure = "correct the unit of torque_Nm or of position_rad, or axis.inertia_kg_m2";
  const auto* torque = places.column_of("torque_Nm");
  if (torque != nullptr && (other_sign || (is_unit && known.torque_factor > 0.0))) {
    auto changed =
        is_unit && known.torque_factor > 0.0 ? in_other_unit(*torque, known.torque_factor) : *torque;
    if (other_sign) changed = reversed(changed);
    cure = fmt::format("write {} into [columns]", mapping_line(changed));
    if (!other_sign)
      cure += fmt::format(", or axis.inertia_kg_m2 = {:.3g} into the model, whichever is true", seen->value);
  }
  const bool is_own = places.is_stated("torque_Nm") && places.is_stated("position_rad");
  const bool is_error = (is_unit || other_sign || ratio > kFarTooHeavy) && !is_own;
  add_implausible(recording, places, is_error ? trial_unusable : note, "torque_Nm",
                  fmt::format("accelerates the axis like an inertia of {:.3g} +- {:.1g} kg m2, "
                              "and axis.inertia_kg_m2 is {:.3g}: {:.3g} times that{}",
                              seen->value, seen->error, believed, ratio,
                              is_unit      ? fmt::format(" ({})", known.text)
                              : other_sign ? " (the torque has the other sign)"
                                           : ""),
                  std::move(cure));
}

}  // namespace sandhopper
