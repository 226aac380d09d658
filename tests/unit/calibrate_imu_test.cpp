#include <gmock/gmock.h>

#include "tests/unit/calibration_bench.hpp"
#include "tools/calibrate/imu.hpp"

namespace sandhopper::calibrate {
namespace {

constexpr std::array<std::array<double, 3>, 12> kUp{{{0, 0, 1},
                                                     {0, 0, -1},
                                                     {1, 0, 0},
                                                     {-1, 0, 0},
                                                     {0, 1, 0},
                                                     {0, -1, 0},
                                                     {0.06, 0.08, 0.995},
                                                     {0.6, 0, -0.8},
                                                     {0.8, 0.6, 0},
                                                     {-0.96, 0, 0.28},
                                                     {0, 0.8, -0.6},
                                                     {0.28, -0.96, 0}}};

LinuxBoardConfig real_board() {
  LinuxBoardConfig board;
  auto& imu = board.imu_foot;
  imu.accel_scale = {1.013, 0.992, 1.006};
  imu.accel_bias_mps2 = {0.21, -0.34, 0.12};
  imu.gyro_bias_radps = {0.012, -0.02, 0.005};
  imu.mount = {0, 1, 0, -1, 0, 0, 0, 0, 1};
  return board;
}

LinuxBoardConfig believed_board() {
  LinuxBoardConfig board;
  board.imu_foot.mount = real_board().imu_foot.mount;
  return board;
}

// A sensor with exactly the errors of real_board().
std::vector<Recording> record(std::uint64_t seed, std::size_t poses = kUp.size()) {
  WorldConfig world;
  world.spread.imu_raw_offset_mps2 = world.spread.imu_scale_relative = world.spread.imu_gyro_bias_radps = 0.0;
  std::vector<Step> steps;
  for (std::size_t i = 0; i < poses; ++i) {
    steps.push_back({.prompt = "", .fixture = {}, .seconds = 1.0});
    const auto& up = kUp[i];
    const double length = std::sqrt(up[0] * up[0] + up[1] * up[1] + up[2] * up[2]);
    steps.back().fixture.foot_up = {up[0] / length, up[1] / length, up[2] / length};
  }
  return record_on_sim(
      {}, believed_board(),
      {.world = world, .real_robot = {}, .real_board = real_board(), .trial = {.seed = seed}}, steps);
}

Outcome fit(const std::vector<Recording>& poses) {
  return calibrate_imu(poses, {"imu_foot", &Recording::imu_foot}, believed_board().imu_foot,
                       {.gravity_mps2 = kGravity_mps2});
}

TEST(CalibrateImu, FindsScaleAndBiasAlongTheSensorsAxes) {
  const auto real = real_board().imu_foot;
  Coverage accel, gyro;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const auto outcome = fit(record(seed));
    ASSERT_EQ(reasons(outcome), "") << outcome.refusals.front().text;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto at = "[" + std::to_string(axis) + "]";
      accel.see(value_of(outcome, "imu_foot.accel_scale" + at), real.accel_scale[axis]);
      accel.see(value_of(outcome, "imu_foot.accel_bias_mps2" + at), real.accel_bias_mps2[axis]);
      gyro.see(value_of(outcome, "imu_foot.gyro_bias_radps" + at), real.gyro_bias_radps[axis]);
      EXPECT_LT(value_of(outcome, "imu_foot.accel_bias_mps2" + at).ci95, 0.01);
      EXPECT_LT(value_of(outcome, "imu_foot.accel_scale" + at).ci95, 0.001);
    }
  }
  EXPECT_GE(accel.held, 41) << "of 48";
  EXPECT_GE(gyro.held, 19) << "of 24";
}

TEST(CalibrateImu, EightPosesAreTooFew) { EXPECT_EQ(reasons(fit(record(1, 8))), "too_few_points"); }

TEST(CalibrateImu, AFaceThatIsMissingIsNamed) {
  auto poses = record(1);
  poses[1] = poses[0];
  const auto outcome = fit(poses);
  EXPECT_EQ(reasons(outcome), "poses_too_alike");
  EXPECT_THAT(outcome.refusals.front().text, ::testing::HasSubstr("-z"));
}

TEST(CalibrateImu, APoseThatMovesIsRefused) {
  auto poses = record(1);
  for (std::size_t i = 0; i < poses[4].imu_foot.size(); ++i)
    poses[4].imu_foot[i].accel_mps2[0] += 0.3 * std::sin(0.01 * static_cast<double>(i));
  EXPECT_THAT(reasons(fit(poses)), ::testing::StartsWith("moving"));
}

TEST(CalibrateImu, APoseThatFeelsMoreThanGravityIsNamed) {
  auto poses = record(1);
  for (auto& sample : poses[7].imu_foot) sample.accel_mps2[2] -= 0.6;
  const auto outcome = fit(poses);
  EXPECT_THAT(reasons(outcome), ::testing::StartsWith("outlier"));
  EXPECT_THAT(outcome.refusals.front().text, ::testing::HasSubstr("without pose 8"));
}

TEST(CalibrateImu, ASensorAtTheEndOfItsRangeIsRefused) {
  auto poses = record(1);
  poses[3].imu_foot[500].accel_mps2[0] = -156.9;
  EXPECT_THAT(reasons(fit(poses)), ::testing::HasSubstr("saturated"));
}

}  // namespace
}  // namespace sandhopper::calibrate
