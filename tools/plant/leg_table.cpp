#include "tools/plant/leg_table.hpp"

#include <cmath>
#include <cstddef>

namespace sandhopper {
namespace {

constexpr double kFirst_rad = -0.1, kStep_rad = 1.0 / 192.0;
constexpr std::size_t kIntervals = 576;  // up to 2.9 rad

struct Keyed {
  std::vector<double> key;
  std::shared_ptr<const LegTable> table;
};

std::vector<double> key_of(const LegParameters& parameters) {
  std::vector<double> key;
  LegParameters::fields(parameters, [&](const char*, const auto& value, const auto&) {
    key.push_back(static_cast<double>(value));
  });
  return key;
}

}  // namespace

LegTable::LegTable(const Leg& leg) : leg_(leg), intervals_(kIntervals) {
  std::vector<Quantities> at;
  for (std::size_t i = 0; i < kIntervals + 3; ++i) {
    const auto d = leg_.dynamics(kFirst_rad + kStep_rad * (static_cast<double>(i) - 1.0));
    at.push_back({d.leg.length_m, d.leg.dlength_m_per_rad, d.leg.d2length_m_per_rad2, d.m12_kg_m, d.m22_kg_m2,
                  d.dm22_kg_m2_per_rad, d.torque_gain_per_m, d.reduced_mass_kg, d.coriolis_N_s2_per_rad2,
                  0.0});
  }
  for (std::size_t i = 0; i < kIntervals; ++i)
    for (std::size_t k = 0; k < kQuantities; ++k) {
      const double before = at[i][k], left = at[i + 1][k], right = at[i + 2][k], after = at[i + 3][k];
      intervals_[i].c0[k] = left;
      intervals_[i].c1[k] = right - before / 3.0 - left / 2.0 - after / 6.0;
      intervals_[i].c2[k] = 0.5 * (before + right) - left;
      intervals_[i].c3[k] = 0.5 * (left - right) + (after - before) / 6.0;
    }
}

inline bool LegTable::interpolate(double angle_rad, std::size_t count, Quantities& q) const noexcept {
  const double place = (angle_rad - kFirst_rad) / kStep_rad;
  if (!(place >= 0.0 && place < static_cast<double>(kIntervals))) return false;
  const auto i = static_cast<std::size_t>(place);
  const double u = place - static_cast<double>(i);
  const auto& [c0, c1, c2, c3] = intervals_[i];
  for (std::size_t k = 0; k < count; ++k) q[k] = c0[k] + u * (c1[k] + u * (c2[k] + u * c3[k]));
  return true;
}

LegKinematics LegTable::kinematics(double angle_rad) const noexcept {
  Quantities q;
  if (!interpolate(angle_rad, 3, q)) return leg_.kinematics(angle_rad);
  return {q[0], q[1], q[2]};
}

LegDynamics LegTable::dynamics(double angle_rad) const noexcept {
  Quantities q;
  if (!interpolate(angle_rad, kQuantities, q)) return leg_.dynamics(angle_rad);
  LegDynamics d{};
  d.leg = {q[0], q[1], q[2]};
  d.m11_kg = leg_.total_mass_kg();
  d.m12_kg_m = q[3];
  d.m22_kg_m2 = q[4];
  d.dm22_kg_m2_per_rad = q[5];
  d.torque_gain_per_m = q[6];
  d.reduced_mass_kg = q[7];
  d.coriolis_N_s2_per_rad2 = q[8];
  return d;
}

std::shared_ptr<const LegTable> leg_table(const Leg& leg) {
  thread_local std::array<Keyed, 4> kept{};
  thread_local std::size_t next = 0;
  auto key = key_of(leg.parameters());
  for (const auto& known : kept)
    if (known.key == key) return known.table;
  auto table = std::make_shared<const LegTable>(leg);
  kept[next++ % kept.size()] = {std::move(key), table};
  return table;
}

}  // namespace sandhopper
