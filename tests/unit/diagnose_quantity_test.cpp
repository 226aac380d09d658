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

std::string order(const std::string& kind, const std::string& profile,
                  const std::map<std::string, double>& setup) {
  std::map<std::string, std::string> words;
  if (!profile.empty()) words["profile"] = profile;
  return trial_in_words(kind, words, setup, Telling::order);
}

TEST(DiagnoseQuantity, TellsALabWhatToDo) {
  EXPECT_EQ(order("drop", "", {{"release_height_m", 1.9}, {"release_speed_mps", 0.0}}),
            "Drop the body from 1.9 m");
  EXPECT_EQ(order("drop", "", {{"release_speed_mps", 0.0}}), "Drop the body once more");
  EXPECT_EQ(
      order("drop", "", {{"release_height_m", 3.741657}, {"release_speed_mps", 3.0}, {"payload_kg", 0.1}}),
      "Throw the body down from 3.74 m at 3 m/s, payload 0.1 kg");
  EXPECT_EQ(order("hop", "", {{"release_height_m", 0.05}, {"compression_stiffness_N_per_m", 1250.0}}),
            "Let the robot hop from 50 mm with a leg stiffness of 1250 N/m");
  EXPECT_EQ(order("intrusion", "cycles", {{"depth_m", 0.046}, {"impact_speed_mps", 0.53}}),
            "Push the plate in and pull it out in cycles to 46 mm at 0.53 m/s");
  EXPECT_EQ(order("intrusion", "stop_and_withdraw",
                  {{"depth_m", 0.046}, {"impact_speed_mps", 0.02}, {"plate_diameter_m", 0.06}}),
            "Push the plate of 60 mm diameter in to 46 mm at 0.02 m/s, stop and pull it out");
  EXPECT_EQ(order("motion", "sine", {{"amplitude_rad", 0.3}, {"frequency_Hz", 1.5}, {"duration_s", 4.0}}),
            "Drive the axis along a sine of 0.3 rad at 1.5 Hz for 4 s");
  EXPECT_EQ(order("motion", "release", {{"release_position_rad", 1.5}, {"duration_s", 4.0}}),
            "Let the axis go from 1.5 rad and record it for 4 s");
  EXPECT_EQ(order("hold", "", {{"position_rad", 0.5}, {"duration_s", 4.0}}),
            "Hold the axis at 0.5 rad for 4 s");
  EXPECT_EQ(order("other", "slow", {{"load", 1.0}, {"session", 2.0}}),
            "Record a trial of the kind other, slow, load 1");
}

TEST(DiagnoseQuantity, MeasuresShortLengthsInMillimetres) {
  EXPECT_EQ(measured(0.046, "m"), "46 mm");
  EXPECT_EQ(measured(1.9, "m"), "1.9 m");
  EXPECT_EQ(measured(0.0, "m"), "0 m");
  EXPECT_EQ(measured(12345.6, "N/m"), "12346 N/m");
  EXPECT_EQ(measured(0.53333, ""), "0.533");
}

TEST(DiagnoseQuantity, GivesAValueTheDigitsItsIntervalLeaves) {
  EXPECT_EQ(with_interval(0.53223, 0.52453, 0.53993, ""), "0.5322 (95 %: 0.5245 to 0.5399)");
  EXPECT_EQ(with_interval(375.2, 350.0, 400.0, "N/m"), "375 N/m (95 %: 350 to 400)");
  EXPECT_EQ(with_interval(12346.0, 11890.0, 12800.0, "N/m"), "12350 N/m (95 %: 11890 to 12800)");
}

}  // namespace
}  // namespace sandhopper::diagnose
