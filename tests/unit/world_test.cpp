#include "tools/plant/world.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include "tools/plant/nominal_controller.hpp"

namespace sandhopper {
namespace {

constexpr std::int64_t kCycle_ns = 1'000'000;

struct Moments {
  double sum = 0.0, square = 0.0;
  int n = 0;
  void add(double x) {
    sum += x;
    square += x * x;
    ++n;
  }
  double mean() const { return sum / n; }
  double rms() const { return std::sqrt(square / n); }
  double deviation() const { return std::sqrt(square / n - mean() * mean()); }
};

// Readings of a hop under the nominal controller, one vector per cycle.
std::vector<double> readings_of_a_hop(const WorldConfig& config, std::uint64_t seed, bool noise = true) {
  World world(config, {.seed = seed, .noise = noise}, 0);
  NominalController controller(config.controller, 375.0);
  world.open_catch();
  std::vector<double> all;
  for (int ms = 1; ms <= 450; ++ms) {
    const auto& truth = world.truth();
    const double torque_Nm =
        controller.step(world.plant().leg(), {truth.foot_z_m, truth.leg_angle_rad, truth.leg_velocity_radps});
    for (const Side side : {Side::left, Side::right}) {
      world.command(side, {.torque_Nm = torque_Nm / 2}, true);
      const auto motor = world.read_motor(side);
      all.insert(all.end(), {motor.position_rad, motor.velocity_radps, motor.current_A});
    }
    world.advance_to(ms * kCycle_ns);
    all.insert(all.end(),
               {world.imu_body().accel_mps2[2], world.imu_foot().accel_mps2[2], world.tof().height_m,
                world.load_cell().force_N, truth.mocap_foot_z_m, truth.foot_z_m});
  }
  return all;
}

// Bitwise equality, so that NaN (not measured yet) equals NaN.
bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

TEST(World, ASeedGivesTheSameBitsAndAnotherSeedOthers) {
  const WorldConfig config;
  EXPECT_TRUE(same_bits(readings_of_a_hop(config, 7), readings_of_a_hop(config, 7)));
  EXPECT_FALSE(same_bits(readings_of_a_hop(config, 7), readings_of_a_hop(config, 8)));
  EXPECT_TRUE(same_bits(readings_of_a_hop(config, 7, false), readings_of_a_hop(config, 8, false)));
}

TEST(World, OneSensorsNoiseDoesNotShiftAnothers) {
  const WorldConfig config;
  WorldConfig quiet = config;
  quiet.sensors.load_cell_noise_N = 0.0;
  quiet.sensors.imu_noise_mps2 = 0.5;
  quiet.spread.tof_bias_m = 0.0;
  const auto a = readings_of_a_hop(config, 3);
  const auto b = readings_of_a_hop(quiet, 3);
  const std::size_t width = 12;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const std::size_t column = i % width;
    const bool changed = column == 6 || column == 7 || column == 8 || column == 9;
    if (!changed && !std::isnan(a[i])) {
      ASSERT_EQ(a[i], b[i]) << "column " << column;
    }
  }
}

TEST(World, LookingOftenChangesNothing) {
  const WorldConfig config;
  World seldom(config, {}, 0), often(config, {}, 0);
  for (std::int64_t t = 0; t <= 100 * kCycle_ns; t += 37'000) {
    often.advance_to(t);
    (void)often.read_motor(Side::left);
  }
  often.advance_to(100 * kCycle_ns);
  seldom.advance_to(100 * kCycle_ns);
  EXPECT_EQ(seldom.read_motor(Side::left).current_A, often.read_motor(Side::left).current_A);
  EXPECT_EQ(seldom.imu_foot().accel_mps2, often.imu_foot().accel_mps2);
  EXPECT_EQ(seldom.load_cell().force_N, often.load_cell().force_N);
}

TEST(World, HeldByTheCatchItReadsGravityAndStandsStill) {
  World world({}, {.noise = false}, 5 * kCycle_ns);
  world.command(Side::left, {.torque_Nm = 1.0}, true);
  world.command(Side::right, {.torque_Nm = 1.0}, true);
  world.advance_to(1'000 * kCycle_ns);
  EXPECT_NEAR(world.imu_body().accel_mps2[2], 9.81, 1e-12);
  EXPECT_NEAR(world.imu_foot().accel_mps2[2], 9.81, 1e-12);
  EXPECT_EQ(world.truth().foot_z_m, 0.0618);
  EXPECT_NEAR(world.truth().body_z_m, 0.0618 + 0.12 + 0.30, 1e-12);
  EXPECT_NEAR(world.tof().height_m, world.truth().body_z_m, 1e-12);
  EXPECT_EQ(world.load_cell().force_N, 0.0);
  EXPECT_NEAR(world.read_motor(Side::left).current_A, 1.0 / 0.0868, 1e-6);
  EXPECT_FALSE(world.truth().released);
  world.command(Side::left, {}, false);
  world.command(Side::right, {}, false);
  world.advance_to(1'010 * kCycle_ns);
  world.open_catch();
  world.advance_to(1'050 * kCycle_ns);
  EXPECT_LT(world.imu_foot().accel_mps2[2], 1.0);  // free fall, apart from the rail's friction
  EXPECT_LT(world.truth().foot_z_m, 0.0618);
}

// Noise, offset and rounding of the sensors at rest, while the catch holds the robot.
TEST(World, SensorNoiseAtRestHasTheStatedSize) {
  const WorldConfig config;
  Moments imu, gyro, tof, force, current, position, velocity, mocap;
  Moments imu_offset, tof_bias, current_offset;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    World world(config, {.seed = seed}, 0);
    const double angle_rad = world.truth().leg_angle_rad;
    Moments imu_trial, gyro_trial, tof_trial, current_trial;
    std::int64_t tof_ns = 0, mocap_ns = 0;
    for (int ms = 1; ms <= 500; ++ms) {
      world.advance_to(ms * kCycle_ns);
      imu_trial.add(world.imu_body().accel_mps2[2] - 9.81);
      gyro_trial.add(world.imu_foot().gyro_radps[0]);
      force.add(world.load_cell().force_N);
      const auto motor = world.read_motor(Side::right);
      current_trial.add(motor.current_A);
      position.add(motor.position_rad - angle_rad);
      velocity.add(motor.velocity_radps);
      if (world.tof().time_ns != tof_ns) {
        tof_ns = world.tof().time_ns;
        tof_trial.add(world.tof().height_m - world.truth().body_z_m);
      }
      if (world.truth().mocap_time_ns != mocap_ns) {
        mocap_ns = world.truth().mocap_time_ns;
        mocap.add(world.truth().mocap_foot_z_m - world.truth().foot_z_m);
      }
    }
    imu.add(imu_trial.deviation());
    gyro.add(gyro_trial.deviation());
    tof.add(tof_trial.deviation());
    current.add(current_trial.deviation());
    imu_offset.add(imu_trial.mean());
    tof_bias.add(tof_trial.mean());
    current_offset.add(current_trial.mean());
  }
  std::printf(
      "IMU %.4f m/s^2, gyro %.5f rad/s, ToF %.2f mm, load cell %.3f N, current %.3f A, encoder %.2e rad, "
      "speed %.3f rad/s, mocap %.3f mm\n",
      imu.mean(), gyro.mean(), 1e3 * tof.mean(), force.rms(), current.mean(), position.rms(), velocity.rms(),
      1e3 * mocap.rms());
  std::printf("from trial to trial: IMU raw offset %.3f m/s^2, ToF %.2f mm, current %.4f A\n",
              imu_offset.deviation(), 1e3 * tof_bias.deviation(), current_offset.deviation());
  EXPECT_NEAR(imu.mean(), std::hypot(0.012, 4.785645e-3 / std::sqrt(12.0)), 0.0003);
  EXPECT_NEAR(gyro.mean(), 0.0017, 0.0001);
  EXPECT_NEAR(tof.mean(), 0.005, 0.0002);
  EXPECT_NEAR(force.rms(), 0.3, 0.01);
  EXPECT_NEAR(current.mean(), 0.10, 0.002);
  EXPECT_NEAR(position.rms(), 1.75e-4,
              2e-5);  // at one angle: the rounding error depends on the position within a count
  EXPECT_NEAR(velocity.rms(), 0.14, 0.02);
  EXPECT_NEAR(mocap.rms(), 2e-4, 5e-6);
  EXPECT_NEAR(imu_offset.deviation(), 0.2, 0.06);
  EXPECT_NEAR(tof_bias.deviation(), 0.003, 0.001);
  EXPECT_NEAR(current_offset.deviation(), 0.03, 0.01);
}

TEST(Drive, EncoderRoundsToItsCountsAfterItsNoise) {
  const WorldConfig config;
  Drive drive(config, {}, {.encoder = Random(1, 0), .current = Random(1, 1)});
  Random where(2, 0);
  const double count_rad = 2.0 * std::numbers::pi / 16384.0;
  Moments wrong;
  for (int i = 0; i < 20000; ++i) {
    const double angle_rad = 2.0 * where.uniform();
    drive.measure(angle_rad);
    const double read_rad = drive.sample(0).position_rad;
    ASSERT_NEAR(read_rad / count_rad, std::round(read_rad / count_rad), 1e-9);
    wrong.add(read_rad - angle_rad);
  }
  EXPECT_NEAR(wrong.rms(), std::hypot(1.5e-4, count_rad / std::sqrt(12.0)), 4e-6);
}

TEST(World, ImuBiasThatNoStaticZeroRemovesComesWithTheRelease) {
  WorldConfig config;
  config.sensors.imu_structure_noise_mps2 = 0.0;
  Moments appeared;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    World world(config, {.release_height_m = 0.5, .seed = seed}, 0);
    Moments held, falling;
    for (int ms = 1; ms <= 400; ++ms) {
      world.advance_to(ms * kCycle_ns);
      if (ms == 200) world.open_catch();
      const double wrong = world.imu_foot().accel_mps2[2] - (world.truth().foot_accel_mps2 + 9.81);
      if (ms <= 200) held.add(wrong);
      if (ms > 220 && world.truth().foot_z_m > 0.05) falling.add(wrong);
    }
    appeared.add(falling.mean() - held.mean());
  }
  EXPECT_NEAR(appeared.deviation(), std::hypot(0.05, 0.005 * 8.0),
              0.02);  // bias, and scale error of the gravity that is no longer measured
}

TEST(World, StructureNoiseIsThereInStanceOnly) {
  WorldConfig config;
  config.sensors.imu_bandwidth_Hz = 2000.0;
  Moments stance, flight;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    World world(config, {.seed = seed}, 0);
    NominalController controller(config.controller, 375.0);
    world.open_catch();
    Moments offset;
    for (int ms = 1; ms <= 410; ++ms) {
      const auto& truth = world.truth();
      const double torque_Nm = controller.step(
          world.plant().leg(), {truth.foot_z_m, truth.leg_angle_rad, truth.leg_velocity_radps});
      for (const Side side : {Side::left, Side::right})
        world.command(side, {.torque_Nm = torque_Nm / 2}, true);
      world.advance_to(ms * kCycle_ns);
      const double wrong = world.imu_body().accel_mps2[2] - (truth.body_accel_mps2 + 9.81);
      if (ms > 10 && ms < 110) {
        offset.add(wrong);
      } else if (ms > 300) {
        stance.add(wrong - offset.mean());
      }
    }
    flight.add(offset.deviation());
  }
  EXPECT_NEAR(stance.rms(), 0.3, 0.06);
  EXPECT_LT(flight.mean(), 0.02);
}

// The load cell has 860 samples per second, the cycle runs at 1000 Hz.
TEST(World, FourteenPercentOfCyclesHaveNoFreshLoadCellSample) {
  WorldConfig config;
  config.spread.load_cell_clock_relative = 0.0;
  World world(config, {.seed = 11}, 0);
  int stale = 0;
  std::uint32_t samples = 0;
  for (int ms = 1; ms <= 10000; ++ms) {
    world.advance_to(ms * kCycle_ns);
    if (world.load_cell().samples == samples) ++stale;
    samples = world.load_cell().samples;
  }
  EXPECT_NEAR(stale, 1400, 2);
}

TEST(World, EverySensorRunsAtItsOwnRateWithItsOwnClock) {
  Moments imu_Hz, difference_Hz, cell_Hz, without_fresh, tof_Hz;
  const double seconds = 2.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    World world({}, {.seed = seed}, 0);
    int stale = 0, tof = 0;
    std::uint32_t cells = 0;
    std::int64_t tof_ns = 0;
    for (int ms = 1; ms <= 2000; ++ms) {
      world.advance_to(ms * kCycle_ns);
      if (world.load_cell().samples == cells) ++stale;
      cells = world.load_cell().samples;
      if (world.tof().time_ns != tof_ns) ++tof;
      tof_ns = world.tof().time_ns;
    }
    imu_Hz.add(world.imu_body().samples / seconds);
    difference_Hz.add((world.imu_body().samples - static_cast<double>(world.imu_foot().samples)) / seconds);
    cell_Hz.add(world.load_cell().samples / seconds);
    tof_Hz.add(tof / seconds);
    without_fresh.add(stale / 2000.0);
  }
  std::printf(
      "IMU %.0f +- %.0f Hz, load cell %.0f +- %.0f Hz, ToF %.1f Hz; cycles without a fresh load-cell sample "
      "%.1f %%\n",
      imu_Hz.mean(), imu_Hz.deviation(), cell_Hz.mean(), cell_Hz.deviation(), tof_Hz.mean(),
      100.0 * without_fresh.mean());
  EXPECT_NEAR(imu_Hz.mean(), 1666.0, 15.0);
  EXPECT_GT(difference_Hz.deviation(), 5.0);
  EXPECT_NEAR(cell_Hz.mean(), 860.0, 20.0);
  EXPECT_GT(cell_Hz.deviation(), 10.0);
  EXPECT_NEAR(tof_Hz.mean(), 500.0, 1.5);
  EXPECT_NEAR(without_fresh.mean(), 0.14, 0.02);
}

TEST(World, TimeOfFlightAppearsAfterItsLatencyStampedWithItsMeasurement) {
  World world({}, {.release_height_m = 0.5, .noise = false}, 0);
  world.open_catch();
  std::int64_t before_ns = 0;
  double height_then_m = 0.0;
  std::vector<PlantTruth> history;
  for (int step = 1; step <= 2000; ++step) {
    world.advance_to(step * World::kStep_ns);
    history.push_back(world.truth());
    if (world.tof().time_ns == before_ns) continue;
    before_ns = world.tof().time_ns;
    EXPECT_GE(world.now_ns() - before_ns, 2 * kCycle_ns);
    EXPECT_LT(world.now_ns() - before_ns, 2 * kCycle_ns + World::kStep_ns);
    const auto then = static_cast<std::size_t>(before_ns / World::kStep_ns) - 1;
    height_then_m = history[then].body_z_m;
    EXPECT_NEAR(world.tof().height_m, height_then_m, 1e-4);
  }
  EXPECT_GT(before_ns, 0);
}

TEST(World, NextSampleTimeIsWhenOneOfTheFourChanges) {
  World world({}, {.seed = 4}, 123'456);
  for (int i = 0; i < 2000; ++i) {
    const auto body = world.imu_body().samples;
    const auto foot = world.imu_foot().samples;
    const auto cell = world.load_cell().samples;
    const auto tof = world.tof().time_ns;
    const auto changed = [&] {
      return world.imu_body().samples != body || world.imu_foot().samples != foot ||
             world.load_cell().samples != cell || world.tof().time_ns != tof;
    };
    const auto next_ns = world.next_sample_ns();
    ASSERT_GT(next_ns, world.now_ns());
    ASSERT_EQ((next_ns - 123'456) % World::kStep_ns, 0);
    world.advance_to(next_ns - 1);
    ASSERT_FALSE(changed());
    world.advance_to(next_ns);
    ASSERT_TRUE(changed());
  }
}

TEST(World, DriveLimitsLagsAndFollowsItsLaw) {
  World world({}, {.noise = false}, 0);
  const double kt = 0.0868;
  world.command(Side::left, {.torque_Nm = 9.0}, true);
  world.advance_to(500'000);  // one time constant
  EXPECT_NEAR(world.read_motor(Side::left).current_A * kt, 2.8 * (1.0 - std::exp(-1.0)), 1e-9);
  // only the left motor makes torque
  EXPECT_NEAR(world.truth().motor_torque_Nm, 2.8 * (1.0 - std::exp(-1.0)), 1e-9);
  const double angle_rad = world.truth().leg_angle_rad;
  world.command(Side::left,
                {.position_rad = angle_rad + 0.01,
                 .velocity_radps = 2.0,
                 .kp_Nm_per_rad = 30.0,
                 .kd_Nm_s_per_rad = 0.2,
                 .torque_Nm = 0.1},
                true);
  world.advance_to(20 * kCycle_ns);
  EXPECT_NEAR(world.read_motor(Side::left).current_A * kt, 0.3 + 0.4 + 0.1, 1e-9);
  world.command(Side::left, {.torque_Nm = 1.0}, false);
  world.advance_to(40 * kCycle_ns);
  EXPECT_NEAR(world.read_motor(Side::left).current_A, 0.0, 1e-9);
}

TEST(World, SpeedReadingLagsByItsFilter) {
  WorldConfig config;
  World world(config, {.release_height_m = 0.5, .noise = false}, 0);
  world.open_catch();
  for (const Side side : {Side::left, Side::right})
    world.command(side, {.position_rad = world.truth().leg_angle_rad + 0.3, .kp_Nm_per_rad = 3.0}, true);
  std::vector<double> speed;
  double worst = 0.0;
  for (int step = 1; step <= 600; ++step) {
    world.advance_to(step * World::kStep_ns);
    speed.push_back(world.truth().leg_velocity_radps);
    const double age_s = 1.0 / (2.0 * std::numbers::pi * 120.0);
    const auto age = static_cast<std::size_t>(std::lround(age_s / 1e-4));
    if (step > 200)
      worst = std::max(worst,
                       std::abs(world.read_motor(Side::left).velocity_radps - speed[speed.size() - 1 - age]));
  }
  EXPECT_LT(worst, 0.25);
  EXPECT_NE(world.read_motor(Side::left).velocity_radps, world.truth().leg_velocity_radps);
}

TEST(World, AReleaseInsideTheBedIsRefused) {
  EXPECT_THROW(World({}, {.release_height_m = -0.01}, 0), std::invalid_argument);
}

}  // namespace
}  // namespace sandhopper
