#include "tools/terrain/rigid_ground.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace sandhopper {
namespace {

using ::testing::HasSubstr;

// A mass falls at 1 m/s onto a spring, bounces and falls back to its start; sampled every 0.5 ms.
LegHop bounce(double stiffness_N_per_m, double mass_kg) {
  constexpr double kStep_s = 1e-5, kGravity = 9.80665;
  LegHop hop{.trial = "bounce"};
  double height = 0.02, speed = -std::sqrt(1.0 - 2.0 * kGravity * 0.02);
  const double start = height;
  bool rising = false;
  for (int i = 0; i < 200000; ++i) {
    const double force = height < 0.0 ? -stiffness_N_per_m * height : 0.0;
    if (i % 50 == 0) {
      hop.reference_t_s.push_back(i * kStep_s);
      hop.reference_N.push_back(force);
    }
    speed += (force / mass_kg - kGravity) * kStep_s;
    height += speed * kStep_s;
    rising = rising || speed > 0.5;
    if (rising && speed < 0.0 && height < start) break;
  }
  for (double t = 0.0; t < hop.reference_t_s.back(); t += 0.001) {
    hop.t_s.push_back(t);
    hop.angle_rad.push_back(1.0);
    hop.torque_Nm.push_back(0.0);
    hop.stance.push_back(1.0);
  }
  return hop;
}

TEST(RigidGround, BoundIsBelowTheTruthAndSoftGroundIsNotCalledRigid) {
  for (const double stiffness : {1000.0, 2000.0, 100e3}) {
    const std::vector<LegHop> hops(4, bounce(stiffness, 1.25));
    const auto ground = rigid_ground(hops, 0.0, 1.25);
    ASSERT_EQ(ground.landings.size(), 4u) << stiffness;
    EXPECT_NEAR(ground.landings[0].speed_mps, 1.0, 0.02) << stiffness;
    EXPECT_LT(ground.at_least_N_per_m, stiffness);
    EXPECT_GT(ground.at_least_N_per_m, 0.1 * stiffness);
    EXPECT_EQ(ground.rigid(), stiffness > 50e3);
    EXPECT_THAT(rigid_answer(ground), HasSubstr(stiffness > 50e3 ? "is rigid: at least" : "not shown"));
    EXPECT_TRUE(rigid_json(ground)["stiffness_N_per_m"].is_null());
  }
}

TEST(RigidGround, WithoutALandingThereIsNoBound) {
  auto hop = bounce(100e3, 1.25);
  for (double& force : hop.reference_N) force += 50.0;
  const auto ground = rigid_ground(std::vector<LegHop>{hop}, 0.0, 1.25);
  EXPECT_TRUE(ground.landings.empty());
  EXPECT_FALSE(ground.rigid());
  EXPECT_THAT(rigid_answer(ground), HasSubstr("Nothing here bounds"));
}

}  // namespace
}  // namespace sandhopper
