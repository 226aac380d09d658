#include "tools/terrain/leg_hop.hpp"

#include <fmt/format.h>

#include <cmath>

namespace sandhopper {
namespace {

constexpr double kDefaultSettling_s = 0.015;
constexpr std::size_t kFewestRows = 50;

// Mean of both sides, or the only side that was recorded. Empty if there is none.
std::vector<double> of_sides(const TrialRecording& recording, const std::string& quantity, double scale) {
  const auto* left = recording.find("motor_left_" + quantity);
  const auto* right = recording.find("motor_right_" + quantity);
  if (left == nullptr) left = recording.find("command_left_" + quantity);
  if (right == nullptr) right = recording.find("command_right_" + quantity);
  if (left == nullptr) std::swap(left, right);
  if (left == nullptr) return {};
  std::vector<double> out(*left);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = scale * (right == nullptr ? out[i] : 0.5 * (out[i] + (*right)[i]));
  return out;
}

// Parameters of the believed leg as a list of numbers, in the order of its fields.
std::vector<double> numbers_of(const LegParameters& leg) {
  std::vector<double> numbers;
  LegParameters::fields(leg, [&](std::string_view, const auto& value, auto&&...) {
    numbers.push_back(static_cast<double>(value));
  });
  return numbers;
}

LegParameters leg_of(const std::vector<double>& numbers) {
  LegParameters leg;
  std::size_t i = 0;
  LegParameters::fields(leg, [&](std::string_view, auto& value, auto&&...) {
    value = static_cast<std::remove_reference_t<decltype(value)>>(numbers.at(i++));
  });
  return leg;
}

}  // namespace

void keep_leg_hop(const CampaignTrial& trial, const TrialRecording& recording, TrialResult& result) {
  const auto angle = of_sides(recording, "position_rad", 1.0);
  const auto torque = of_sides(recording, "torque_Nm", 2.0);
  const auto* phase = recording.find("phase");
  const auto* force = recording.find("load_cell_force_N");
  if (angle.empty() || torque.empty() || phase == nullptr || force == nullptr) {
    result.ruled_out.push_back(
        "the leg's force estimate against the force plate: needs motor_left_position_rad, "
        "command_left_torque_Nm, phase and load_cell_force_N");
    return;
  }
  auto& series = result.series;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    const double t = recording.t_s[row];
    if (!std::isnan((*force)[row])) {
      series["leg_hop_reference_t_s"].push_back(t);
      series["leg_hop_reference_N"].push_back((*force)[row]);
    }
    if (std::isnan(angle[row]) || std::isnan(torque[row]) || std::isnan((*phase)[row])) continue;
    series["leg_hop_t_s"].push_back(t);
    series["leg_hop_angle_rad"].push_back(angle[row]);
    series["leg_hop_torque_Nm"].push_back(torque[row]);
    series["leg_hop_stance"].push_back((*phase)[row] > 0.0 ? 1.0 : 0.0);
  }
  if (!holds_leg_hop(result))
    result.ruled_out.push_back(fmt::format(
        "the leg's force estimate against the force plate: fewer than {} rows of either", kFewestRows));
  series["leg_hop_held_out"] = {trial.flag("held_out").value_or(false) ? 1.0 : 0.0};
  series["leg_hop_contact_settling_s"] = {trial.number("contact_settling_s").value_or(kDefaultSettling_s)};
  series["leg_hop_leg"] = numbers_of(std::get<HopperBelief>(trial.belief).robot.leg);
}

bool holds_leg_hop(const TrialResult& result) {
  const auto enough = [&](const char* name) {
    const auto found = result.series.find(name);
    return found != result.series.end() && found->second.size() >= kFewestRows;
  };
  return enough("leg_hop_t_s") && enough("leg_hop_reference_N");
}

LegHop leg_hop_from(const TrialResult& result) {
  const auto& series = result.series;
  return {.trial = result.trial,
          .held_out = series.at("leg_hop_held_out").front() > 0.0,
          .contact_settling_s = series.at("leg_hop_contact_settling_s").front(),
          .t_s = series.at("leg_hop_t_s"),
          .angle_rad = series.at("leg_hop_angle_rad"),
          .torque_Nm = series.at("leg_hop_torque_Nm"),
          .stance = series.at("leg_hop_stance"),
          .reference_t_s = series.at("leg_hop_reference_t_s"),
          .reference_N = series.at("leg_hop_reference_N"),
          .leg = leg_of(series.at("leg_hop_leg"))};
}

}  // namespace sandhopper
