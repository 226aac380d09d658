#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <vector>

#include "tools/diagnose/plants/hopper/hopper_runs.hpp"

namespace sandhopper::diagnose {
namespace {

double nothing(const PortState&) { return 0.0; }

// A change that affects only the reading of one sensor needs no new run. A law of an encoder affects the
// controller; without a key that identifies it, its run cannot be shared.
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
  at_port.law(LawPort::rail, nothing);
  at_port.laws_key = 0;
  EXPECT_TRUE(HopperRuns::key(at_port, nuisances).empty());
}

// A run is simulated once for all sensors. A sensor's reading is computed again only if this sensor changes.
TEST(DiagnoseHopperRuns, AReadingIsMadeAgainOnlyWhereItsOwnSensorReadsOtherwise) {
  HopperRuns runs(2);
  Edits plain;
  plain.laws_key = 1;
  int made_runs = 0, made_readings = 0;
  const auto read = [&](const Edits& edits, double plant, double offset) {
    auto& run = runs.run(HopperRuns::key(edits, std::vector{plant}), 0, [&] {
      ++made_runs;
      return HopperTraces{};
    });
    std::vector<double> out(3, -1.0);
    run.read(4, HopperRuns::reading_key(edits, "tof_height_m", std::vector{offset}), out,
             [&](std::span<double> values) {
               ++made_readings;
               std::ranges::fill(values, 10.0 * plant + offset);
             });
    EXPECT_EQ(out, std::vector<double>(3, 10.0 * plant + offset));
  };
  read(plain, 1.0, 0.0);
  Edits other = plain;
  other.sensor("load_cell_force_N", SensorEdit::Kind::gain, 1.1);
  read(other, 1.0, 0.0);
  EXPECT_EQ(made_runs, 1);
  EXPECT_EQ(made_readings, 1);
  Edits own = plain;
  own.sensor("tof_height_m", SensorEdit::Kind::delay_s, 1e-3);
  read(own, 1.0, 0.0);
  read(plain, 1.0, 0.5);
  EXPECT_EQ(made_runs, 1);
  EXPECT_EQ(made_readings, 3);
  // The oldest of the runs that were requested once is dropped. A run that was requested again stays.
  for (const double plant : {2.0, 3.0, 4.0}) read(plain, plant, 0.0);
  EXPECT_EQ(made_runs, 4);
  read(plain, 1.0, 0.5);
  EXPECT_EQ(made_runs, 4);
  EXPECT_EQ(made_readings, 6);
  own.sensor_law("tof_height_m", nothing);
  EXPECT_TRUE(HopperRuns::reading_key(own, "tof_height_m", {}).empty());
}

}  // namespace
}  // namespace sandhopper::diagnose
