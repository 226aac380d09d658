#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <vector>

#include "tools/diagnose/plants/hopper/hopper_runs.hpp"

namespace sandhopper::diagnose {
namespace {

double nothing(const PortState&) { return 0.0; }

// What only a sensor reads otherwise needs no new run; an encoder's law reaches the controller, and one that
// nothing tells apart from others needs its own.
TEST(DiagnoseHopperRuns, AreSharedByWhatOnlyASensorReadsOtherwise) {
  const HopperRuns::RunNuisances nuisances{.always = {0.1, -0.2}};
  Edits plain;
  plain.laws_key = plain.ground_laws_key = 1;
  const auto key = HopperRuns::key(plain, nuisances);
  ASSERT_TRUE(key.known());
  for (const char* channel : {"load_cell_force_N", "imu_foot_accel_z_mps2", "tof_height_m"}) {
    Edits edits = plain;
    edits.sensor_law(channel, nothing);
    EXPECT_EQ(HopperRuns::key(edits, nuisances), key) << channel;
  }
  for (const char* channel : {"motor_left_position_rad", "actuator"}) {
    Edits edits = plain;
    edits.sensor_law(channel, nothing);
    EXPECT_FALSE(HopperRuns::key(edits, nuisances).known()) << channel;
    edits.sensors.back().law_key = 5;
    const auto with_law = HopperRuns::key(edits, nuisances);
    EXPECT_FALSE(with_law == key) << channel;
    edits.sensors.back().law_key = 6;
    EXPECT_FALSE(HopperRuns::key(edits, nuisances) == with_law) << channel;
  }
  Edits at_port = plain;
  at_port.law("rail", nothing);
  at_port.laws_key = 0;
  EXPECT_FALSE(HopperRuns::key(at_port, nuisances).known());
}

// A run is made once for all that is read of it, and a sensor's readings once for what others read otherwise.
TEST(DiagnoseHopperRuns, AReadingIsMadeAgainOnlyWhereItsOwnSensorReadsOtherwise) {
  HopperRuns runs(2);
  Edits plain;
  plain.laws_key = plain.ground_laws_key = 1;
  int made_runs = 0, made_readings = 0;
  const auto read = [&](const Edits& edits, double plant, double offset) {
    auto& run = runs.run(HopperRuns::key(edits, {.always = {plant}}), 0, [&](const HopperResumed&) {
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
  // Of runs that were asked for once the oldest goes; one that was asked for again stays.
  for (const double plant : {2.0, 3.0, 4.0}) read(plain, plant, 0.0);
  EXPECT_EQ(made_runs, 4);
  read(plain, 1.0, 0.5);
  EXPECT_EQ(made_runs, 4);
  EXPECT_EQ(made_readings, 6);
  own.sensor_law("tof_height_m", nothing);
  EXPECT_TRUE(HopperRuns::reading_key(own, "tof_height_m", {}).empty());
}

// A run that differs only in the ground goes on from the touchdown of a known one, one whose bed differs only
// deep down from the last moment above; a bed that differs deeper than the foot gets is the known run.
TEST(DiagnoseHopperRuns, GoOnFromWhereTheyFirstDiffer) {
  const auto hop = [](double stiffness_N_per_m, double deep) {
    HopperRun run;
    run.world.terrain.stiffness_N_per_m = stiffness_N_per_m;
    run.start.foot_z_m = 0.03;
    run.start.angle_rad = Leg(run.world.robot.leg).angle_at_length(0.30);
    run.to_s = 0.4;
    run.fluctuation.relative = 1.0;
    run.fluctuation.spacing_m = 0.002;
    for (std::size_t i = 3; i < BedFluctuation::kKnots; ++i) run.fluctuation.knots[i] = deep;
    return run;
  };
  const auto key = [](double stiffness_N_per_m, double deep) {
    Edits plain;
    plain.laws_key = plain.ground_laws_key = 1;
    HopperRuns::RunNuisances nuisances{.always = {1.0}, .in_ground = {stiffness_N_per_m}};
    nuisances.by_depth = {0.0, 0.0, 0.0, deep};
    nuisances.knot_spacing_m = 0.002;
    return HopperRuns::key(plain, nuisances);
  };
  HopperRuns runs(4);
  std::size_t steps = 0;
  int made = 0;
  const auto run = [&](double stiffness_N_per_m, double deep) -> const HopperTraces& {
    return runs
        .run(key(stiffness_N_per_m, deep), 0,
             [&](const HopperResumed& from) {
               steps = from.at != nullptr ? from.at->step : 0;
               ++made;
               return simulate_hopper(hop(stiffness_N_per_m, deep), {}, from);
             })
        .traces;
  };
  const auto same = [](const HopperTraces& a, const HopperTraces& b) {
    return a.angle_rad.values == b.angle_rad.values && a.force_N.values == b.force_N.values &&
           a.body_accel_mps2.values == b.body_accel_mps2.values && a.bed_reached_m == b.bed_reached_m;
  };
  const HopperTraces known = run(1500.0, 0.0);
  EXPECT_EQ(steps, 0u);
  ASSERT_GT(known.bed_reached_m, 0.004);
  const HopperTraces softer = run(1400.0, 0.0);
  const std::size_t at_touchdown = steps;
  EXPECT_GT(at_touchdown, 200u);  // 0.03 m of fall take 78 ms
  EXPECT_TRUE(same(softer, simulate_hopper(hop(1400.0, 0.0), {})));
  EXPECT_FALSE(same(softer, known));
  const HopperTraces other = run(1500.0, 0.1);
  EXPECT_GT(steps, at_touchdown);
  EXPECT_TRUE(same(other, simulate_hopper(hop(1500.0, 0.1), {})));
  EXPECT_FALSE(same(other, known));
  EXPECT_EQ(made, 3);
  // Hard ground: the foot does not reach the third knot.
  const HopperTraces hard = run(60000.0, 0.0);
  ASSERT_LT(hard.bed_reached_m, 0.004);
  EXPECT_TRUE(same(run(60000.0, 0.1), simulate_hopper(hop(60000.0, 0.1), {})));
  EXPECT_EQ(made, 4);
}

}  // namespace
}  // namespace sandhopper::diagnose
