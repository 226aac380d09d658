#include "tools/campaign/hopper_signals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <variant>

namespace sandhopper {
namespace {

constexpr std::size_t kFewestPairs = 20;
constexpr std::size_t kLagRows = 4096;  // Several strides at 1 kHz; bounds the time of a long recording.

// Mean of the sides' columns times `count`; of the one that is there, if the other is not.
std::vector<double> sum_of_sides(const TrialRecording& recording, std::string_view left,
                                 std::string_view right, int count) {
  const std::array sides{recording.find(left), recording.find(right)};
  std::vector<double> out(recording.rows(), NAN);
  for (std::size_t i = 0; i < out.size(); ++i) {
    double sum = 0.0, known = 0.0;
    for (const auto* side : sides)
      if (side != nullptr && !std::isnan((*side)[i])) sum += (*side)[i], known += 1.0;
    if (known > 0.0) out[i] = sum / known * count;
  }
  return out;
}

// As `together`, for the rows before `end`.
double together_until(const std::vector<double>& a, const std::vector<double>& b, std::size_t from,
                      std::size_t end, std::ptrdiff_t lag) {
  double n = 0, sa = 0, sb = 0, saa = 0, sab = 0, sbb = 0;
  const auto first = static_cast<std::ptrdiff_t>(from), last = static_cast<std::ptrdiff_t>(end);
  for (std::ptrdiff_t i = first; i < last; ++i) {
    const std::ptrdiff_t j = i + lag;
    if (j < first || j >= last) continue;
    const double x = a[static_cast<std::size_t>(i)], y = b[static_cast<std::size_t>(j)];
    if (std::isnan(x) || std::isnan(y)) continue;
    n += 1, sa += x, sb += y, saa += x * x, sab += x * y, sbb += y * y;
  }
  const double aa = saa - sa * sa / n, bb = sbb - sb * sb / n, ab = sab - sa * sb / n;
  if (n < static_cast<double>(kFewestPairs) || !(aa > 0.0) || !(bb > 0.0)) return 0.0;
  return ab * ab / (aa * bb);
}

}  // namespace

const HopperBelief* belief_of_hop(const TrialRecording& recording, const Campaign& campaign,
                                  const CampaignTrial& trial) {
  const bool is_hop = campaign.plant == CampaignPlant::hopper && trial.kind == TrialKind::hop;
  return is_hop && recording.has_time && trial.unstated.empty() ? std::get_if<HopperBelief>(&trial.belief)
                                                                : nullptr;
}

HopperForces hopper_forces(const TrialRecording& recording, const Leg& leg, const HopperBelief& belief) {
  const auto& p = belief.robot.leg;
  const double foot_kg = p.foot_mass_kg + p.lower_link_mass_kg, body_kg = leg.total_mass_kg() - foot_kg;
  const auto angle = sum_of_sides(recording, "motor_left_position_rad", "motor_right_position_rad", 1);
  const auto current =
      sum_of_sides(recording, "motor_left_current_A", "motor_right_current_A", p.motor_count);
  const auto *body = recording.find("imu_body_accel_z_mps2"), *foot = recording.find("imu_foot_accel_z_mps2");
  const std::vector<double> unknown(recording.rows(), NAN);
  HopperForces out{unknown, unknown, unknown};
  for (std::size_t i = 0; i < recording.rows(); ++i) {
    const double slope = leg.kinematics(angle[i]).dlength_m_per_rad;
    if (slope < 0.0) out.leg_N[i] = belief.motor.torque_constant_Nm_per_A * current[i] / slope;
    out.foot_N[i] = out.leg_N[i] + foot_kg * (foot != nullptr ? (*foot)[i] : belief.gravity_mps2);
    if (body != nullptr)
      out.inertia_N[i] = body_kg * (*body)[i] + foot_kg * (foot != nullptr ? (*foot)[i] : (*body)[i]);
  }
  return out;
}

std::vector<bool> loaded_rows(const std::vector<double>& values) {
  double sum = 0.0, count = 0.0;
  for (const double value : values)
    if (!std::isnan(value)) sum += std::abs(value), count += 1.0;
  std::vector<bool> out(values.size(), false);
  for (std::size_t i = 0; i < values.size(); ++i) out[i] = std::abs(values[i]) * count > 0.5 * sum;
  return out;
}

std::optional<std::size_t> first_loaded_row(const std::vector<double>& values) {
  const auto loaded = loaded_rows(values);
  const auto found = std::ranges::find(loaded, true);
  if (found == loaded.end()) return std::nullopt;
  return static_cast<std::size_t>(found - loaded.begin());
}

double together(const std::vector<double>& a, const std::vector<double>& b, std::size_t from,
                std::ptrdiff_t lag) {
  return together_until(a, b, from, std::min(a.size(), b.size()), lag);
}

bool BestLag::is_shifted() const { return at_best > std::max(kBelongTogether, at_zero + kClearlyBetter); }

BestLag best_lag(const std::vector<double>& a, const std::vector<double>& b, std::size_t from) {
  const std::size_t end = std::min({a.size(), b.size(), from + kLagRows});
  BestLag out{0, together_until(a, b, from, end, 0), 0.0};
  const auto most = static_cast<std::ptrdiff_t>(end / 20);
  for (std::ptrdiff_t lag = -most; lag <= most; ++lag)
    if (const double found = together_until(a, b, from, end, lag); found > out.at_best)
      out.at_best = found, out.rows = lag;
  return out;
}

}  // namespace sandhopper
