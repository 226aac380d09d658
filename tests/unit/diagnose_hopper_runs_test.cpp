#include <gtest/gtest.h>

#include <vector>

#include "tools/diagnose/plants/hopper_runs.hpp"

namespace sandhopper::diagnose {
namespace {

double nothing(const PortState&) { return 0.0; }

// What only a sensor reads otherwise needs no new run; an encoder's law reaches the controller, and one that
// nothing tells apart from others needs its own.
TEST(DiagnoseHopperRuns, AreSharedByWhatOnlyASensorReadsOtherwise) {
  const std::vector<double> nuisances{0.1, -0.2};
  Edits plain;
  plain.laws_key = 1;
  const auto key = HopperRuns::key(plain, nuisances);
  ASSERT_FALSE(key.empty());
  for (const char* channel : {"load_cell_force_N", "imu_foot_accel_z_mps2", "tof_height_m"}) {
    Edits edits = plain;
    edits.sensor_law(channel, nothing);
    EXPECT_EQ(HopperRuns::key(edits, nuisances), key) << channel;
  }
  for (const char* channel : {"motor_left_position_rad", "actuator"}) {
    Edits edits = plain;
    edits.sensor_law(channel, nothing);
    EXPECT_TRUE(HopperRuns::key(edits, nuisances).empty()) << channel;
    edits.sensors.back().law_key = 5;
    const auto with_law = HopperRuns::key(edits, nuisances);
    EXPECT_NE(with_law, key) << channel;
    edits.sensors.back().law_key = 6;
    EXPECT_NE(HopperRuns::key(edits, nuisances), with_law) << channel;
  }
  Edits at_port = plain;
  at_port.law("rail", nothing);
  at_port.laws_key = 0;
  EXPECT_TRUE(HopperRuns::key(at_port, nuisances).empty());
}

}  // namespace
}  // namespace sandhopper::diagnose
