#include "tools/trial/series_ground.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "campaign_folder.hpp"
#include "tools/trial/sim_trial.hpp"

namespace sandhopper {
namespace {

std::filesystem::path hopped(const CampaignFolder& folder, double height_m, std::uint64_t seed) {
  SimTrialSetup setup{.trial = {.release_height_m = height_m, .seed = seed},
                      .log = folder.path() / (std::to_string(seed) + ".mcap")};
  setup.robot.limits.strides = 1;
  run_sim_trial(setup);
  return setup.log;
}

TEST(SeriesGround, OffersNoSetUpBeforeAStrideWasMeasured) {
  EXPECT_FALSE(SeriesGround(RobotConfig{}).next());
}

// After a shallow stride the ground below is unknown. The next drop must go deeper, and the band must become
// narrower in the mean of several such drops.
TEST(SeriesGround, OffersTheDropThatNarrowsTheBand) {
  const CampaignFolder folder;
  SeriesGround ground(RobotConfig{});
  ground.add(hopped(folder, 0.0125, 1));
  const auto next = ground.next();
  ASSERT_TRUE(next);
  EXPECT_GT(next->setup.drop_height_m, 0.0125);
  EXPECT_LT(next->widest_expected_N, next->widest_now_N);
  EXPECT_THAT(to_text(*next), ::testing::HasSubstr("a drop from"));
  constexpr std::uint64_t kDrops = 4;
  double widest_N = 0.0;
  for (std::uint64_t drop = 0; drop < kDrops; ++drop) {
    SeriesGround deeper = ground;
    deeper.add(hopped(folder, next->setup.drop_height_m, 2 + drop));
    widest_N += deeper.next()->widest_now_N / kDrops;
  }
  EXPECT_LT(widest_N, 0.9 * next->widest_now_N);
}

}  // namespace
}  // namespace sandhopper
