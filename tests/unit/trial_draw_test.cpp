#include "tools/plant/trial_draw.hpp"

#include <gtest/gtest.h>

#include <optional>

namespace sandhopper {
namespace {

double torque_Nm(std::uint64_t seed, std::optional<std::uint64_t> robot_seed) {
  const WorldConfig config;
  const TrialDraw draw(config, {.seed = seed, .noise = true, .start_ns = 0, .robot_seed = robot_seed});
  Drive drive = draw.drive(Side::left);
  drive.command({.torque_Nm = 1.0}, true);
  for (int i = 0; i < 1000; ++i) drive.step();
  return drive.torque_Nm();
}

// The torque constant is a property of the motors: trials of one robot have the same error of it.
TEST(TrialDraw, TorqueConstantBelongsToTheRobotIfItHasASeed) {
  EXPECT_EQ(torque_Nm(7, 3), torque_Nm(8, 3));
  EXPECT_NE(torque_Nm(7, 3), torque_Nm(7, 4));
  EXPECT_NE(torque_Nm(7, {}), torque_Nm(8, {}));
  EXPECT_EQ(torque_Nm(7, 7), torque_Nm(7, {}));
}

}  // namespace
}  // namespace sandhopper
