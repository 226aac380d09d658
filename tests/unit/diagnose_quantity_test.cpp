#include <gtest/gtest.h>

#include "tools/diagnose/model/quantity.hpp"

namespace sandhopper::diagnose {
namespace {

TEST(DiagnoseQuantity, ReadsTheLongestUnitAtAKeysEnd) {
  EXPECT_EQ(quantity_of("viscous_friction_Nm_s").label(), "viscous friction, N m s");
  EXPECT_EQ(quantity_of("linear_drag_N_s_per_m").label(), "linear drag, N s/m");
  EXPECT_EQ(quantity_of("imu_foot_accel_z_mps2").label(), "imu foot accel z, m/s²");
  EXPECT_EQ(quantity_of("drag_coefficient").label(), "drag coefficient");
  EXPECT_EQ(quantity_of("depth_m, unloading").label(), "depth, unloading, m");
}

TEST(DiagnoseQuantity, TellsATrialInWords) {
  EXPECT_EQ(trial_in_words("motion", {{"profile", "sine"}},
                           {{"amplitude_rad", 0.3}, {"session", 2.0}, {"load", 1.0}}),
            "motion, sine, amplitude 0.3 rad, load 1");
}

TEST(DiagnoseQuantity, GivesAValueTheDigitsItsIntervalLeaves) {
  EXPECT_EQ(with_interval(0.53223, 0.52453, 0.53993, ""), "0.5322 (95 %: 0.5245 to 0.5399)");
  EXPECT_EQ(with_interval(375.2, 350.0, 400.0, "N/m"), "375 N/m (95 %: 350 to 400)");
}

}  // namespace
}  // namespace sandhopper::diagnose
