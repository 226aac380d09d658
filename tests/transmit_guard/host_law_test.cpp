#include "drivers/can/host_law.hpp"

#include <gtest/gtest.h>

namespace sandhopper {
namespace {

constexpr std::int64_t kNow_ns = 100'000'000;
constexpr std::int64_t kOldest_ns = 6'000'000;  // kHostLawAge_s

MotorSample state_at(std::int64_t time_ns, double velocity_radps) {
  return {.time_ns = time_ns, .position_rad = 1.0, .velocity_radps = velocity_radps};
}

TEST(HostLaw, KeepsDampingAndHoldingWithinTheTorqueLimit) {
  const MotorCommand damp{.kd_Nm_s_per_rad = 0.3};
  EXPECT_DOUBLE_EQ(host_law(damp, state_at(kNow_ns, 5.0), kNow_ns, 2.8).torque_Nm, -1.5);
  EXPECT_DOUBLE_EQ(host_law(damp, state_at(kNow_ns, 20.0), kNow_ns, 2.8).torque_Nm, -2.8);
  const MotorCommand hold{.position_rad = 1.5, .kp_Nm_per_rad = 15.0};
  EXPECT_DOUBLE_EQ(host_law(hold, state_at(kNow_ns, 0.0), kNow_ns, 2.8).torque_Nm, 2.8);
  EXPECT_EQ(host_law(hold, state_at(kNow_ns, 0.0), kNow_ns, 2.8).kp_Nm_per_rad, 0.0);
}

TEST(HostLaw, MakesNoTorqueFromGainsAndAnOldState) {
  const MotorCommand damp{.kd_Nm_s_per_rad = 0.3};
  EXPECT_NE(host_law(damp, state_at(kNow_ns - kOldest_ns, 5.0), kNow_ns, 2.8).torque_Nm, 0.0);
  EXPECT_EQ(host_law(damp, state_at(kNow_ns - kOldest_ns - 1, 5.0), kNow_ns, 2.8).torque_Nm, 0.0);
  EXPECT_EQ(host_law(damp, MotorSample{}, kNow_ns, 2.8).torque_Nm, 0.0);
  EXPECT_EQ(host_law({.torque_Nm = 1.0}, MotorSample{}, kNow_ns, 2.8).torque_Nm, 1.0);
}

}  // namespace
}  // namespace sandhopper
