#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/diagnose/discrepancy/left_over.hpp"
#include "tools/diagnose/fit/prepare.hpp"

// Limits of what the noise of the sensors explains: each with a case just inside and one just outside.
namespace sandhopper::diagnose {
namespace {

double nothing(double, double, double) { return 0.0; }

// Noise of the two channels of a falling body, in times of the sensors' own.
struct Levels {
  double height = 1.0, accel = 1.0;
  double innovation = 1.0;  // of the accelerometer: 1 for white noise
};

std::optional<NoisyChannel> noisiest(const Levels& levels) {
  auto prepared = prepare(drops(nothing, 1, 4));
  Problem& problem = prepared.problem;
  std::vector<ChannelNoise> noise;
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    const bool accel = problem.channels[c] == "accel_mps2";
    const double own =
        std::max(believed_noise(problem.context.belief, problem.channels[c]), problem.floor_sd[c]);
    const std::size_t phases = problem.phases.size();
    ChannelNoise of_channel;
    of_channel.sd_of_phase.assign(phases, own * (accel ? levels.accel : levels.height));
    of_channel.correlation_of_phase.assign(phases, Autoregression{{}, accel ? levels.innovation : 1.0});
    of_channel.samples_of_phase.assign(phases, 100.0);
    noise.push_back(std::move(of_channel));
  }
  problem.noise = NoiseModel(std::move(noise));
  return noisiest_channel(problem);
}

TEST(DiagnoseLoud, AChannelIsLoudFromFourAndAHalfTimesItsSensorOn) {
  EXPECT_FALSE(noisiest({.accel = 4.3}));
  EXPECT_TRUE(noisiest({.accel = 4.7}));
}

TEST(DiagnoseLoud, TheSensorAloneIsNoisyIfTheOtherChannelsAreQuiet) {
  const auto quiet = noisiest({.height = 1.25, .accel = 6.0}),
             moved = noisiest({.height = 1.35, .accel = 6.0});
  ASSERT_TRUE(quiet && moved);
  EXPECT_EQ(quiet->port, "accel_mps2");
  EXPECT_NE(moved->port, "accel_mps2");
}

TEST(DiagnoseLoud, ASmoothAccelerationIsReal) {
  const auto smooth = noisiest({.accel = 6.0, .innovation = 0.57}),
             rough = noisiest({.accel = 6.0, .innovation = 0.63});
  ASSERT_TRUE(smooth && rough);
  EXPECT_NE(smooth->port, "accel_mps2");
  EXPECT_EQ(rough->port, "accel_mps2");
}

TEST(DiagnoseLoud, MoreThanTheNoiseIsLeftFromAThirdMoreOn) {
  EXPECT_FALSE((LeftOver{.before = 5.0, .after = 1.3}).is_more_than_noise());
  EXPECT_TRUE((LeftOver{.before = 5.0, .after = 1.4}).is_more_than_noise());
}

TEST(DiagnoseLoud, TwelveTrialsLeanAsMuchAsFourteen) {
  const auto prepared = prepare(drops(nothing, 1, 14));
  const Problem& problem = prepared.problem;
  Point point = null_point(problem);
  for (std::size_t t = 0; t < problem.trials.size(); ++t)
    point.nuisances[t][0] = problem.trials[t]->trial_nuisances[0].sd;
  EXPECT_NEAR(largest_common_shift(problem, point).z, std::sqrt(12.0), 1e-9);
}

}  // namespace
}  // namespace sandhopper::diagnose
