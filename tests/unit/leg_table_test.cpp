#include "tools/plant/leg_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sandhopper {
namespace {

std::array<double, 10> quantities(const LegDynamics& d) {
  return {d.leg.length_m,
          d.leg.dlength_m_per_rad,
          d.leg.d2length_m_per_rad2,
          d.m11_kg,
          d.m12_kg_m,
          d.m22_kg_m2,
          d.dm22_kg_m2_per_rad,
          d.torque_gain_per_m,
          d.reduced_mass_kg,
          d.coriolis_N_s2_per_rad2};
}

TEST(LegTable, SaysWhatTheLegSaysWithinATenMillionthAndOutsideItTheSame) {
  LegParameters parameters;
  parameters.hip_offset_m = 0.02;
  const Leg leg(parameters);
  const LegTable table(leg);
  std::array<double, 10> largest{}, furthest{};
  for (double angle_rad = 0.2; angle_rad < 2.65; angle_rad += 1.7e-4) {
    const auto exact = quantities(leg.dynamics(angle_rad)), read = quantities(table.dynamics(angle_rad));
    for (std::size_t i = 0; i < exact.size(); ++i) {
      largest[i] = std::max(largest[i], std::abs(exact[i]));
      furthest[i] = std::max(furthest[i], std::abs(read[i] - exact[i]));
    }
  }
  for (std::size_t i = 0; i < largest.size(); ++i) EXPECT_LT(furthest[i], 1e-7 * largest[i]) << i;
  for (const double angle_rad : {-0.5, 3.0})
    EXPECT_EQ(table.dynamics(angle_rad).m22_kg_m2, leg.dynamics(angle_rad).m22_kg_m2);
}

TEST(LegTable, IsMadeOnceForALegAndAnewForAnother) {
  LegParameters parameters;
  const auto first = leg_table(Leg(parameters));
  EXPECT_EQ(leg_table(Leg(parameters)), first);
  parameters.foot_mass_kg += 1e-9;
  EXPECT_NE(leg_table(Leg(parameters)), first);
}

}  // namespace
}  // namespace sandhopper
