#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tests/unit/diagnose_hops.hpp"
#include "tools/diagnose/balance.hpp"
#include "tools/diagnose/plants/hopper_balance.hpp"
#include "tools/diagnose/plants/inputs.hpp"
#include "tools/diagnose/plants/rotary_balance.hpp"

namespace sandhopper::diagnose {
namespace {

TEST(DiagnoseBalance, NothingIsAskedWhereAnAccelerometerClipped) {
  Trial trial = recorded(hop_from(0.05, 0.6), {}, 1);
  const auto whole = balances_of(trial, Belief{});
  auto& foot = trial.channels["imu_foot_accel_z_mps2"];
  double clipped = 0;
  for (std::size_t i = 200; i < 220; ++i, ++clipped) foot[i] = std::numeric_limits<double>::quiet_NaN();
  const auto rest = balances_of(trial, Belief{});
  ASSERT_EQ(whole.size(), rest.size());
  for (std::size_t b = 0; b < whole.size(); ++b) {
    EXPECT_NEAR(static_cast<double>(whole[b].rest.size() - rest[b].rest.size()), clipped, 2.0);
    for (const auto& state : rest[b].states) EXPECT_FALSE(state.time_s > 0.2005 && state.time_s < 0.2185);
  }
}

TEST(DiagnoseBalance, WithoutAccelerometersThereIsNone) {
  const Belief belief;
  Trial trial = recorded(hop_from(0.05, 0.6), {}, 1);
  trial.channels.erase("imu_foot_accel_z_mps2");
  EXPECT_TRUE(balances_of(trial, belief).empty());
}

TEST(DiagnoseBalance, AMotionTurnsWhereItComesBackByMoreThanItsNoise) {
  const std::vector<double> angle{0.0, 0.1, 0.2, 0.5, 0.49, 0.51, 0.3, 0.1, -0.2, -0.1, 0.0};
  const std::vector<double> turns{0.0, 0.0, 0.0, 0.0, 0.0, 0.51, 0.51, 0.51, -0.2, -0.2, -0.2};
  const auto found = last_turns(angle, 0.05);
  ASSERT_EQ(found.size(), turns.size());
  for (std::size_t i = 0; i < turns.size(); ++i) EXPECT_DOUBLE_EQ(found[i], turns[i]) << i;
}

}  // namespace
}  // namespace sandhopper::diagnose
