#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/unit/diagnose_campaigns.hpp"

// Delays, biases and sizes near the limit of the tolerances.
namespace sandhopper::diagnose {
namespace {

constexpr double kRow_s = 4e-3;       // of `swings`
constexpr double kPressRow_s = 2e-3;  // of `presses`

double no_torque(double, double, double) { return 0.0; }
double no_force(double, double, double) { return 0.0; }

// Delays a channel by `rows` rows.
void make_late(Recordings& recordings, const std::string& channel, int rows) {
  for (auto& trial : recordings.trials) {
    const auto before = trial.channels[channel];
    const auto last = static_cast<int>(before.size()) - 1;
    for (int i = 0; i <= last; ++i)
      trial.channels[channel][static_cast<std::size_t>(i)] =
          before[static_cast<std::size_t>(std::clamp(i - rows, 0, last))];
  }
}

// `swings` holds its torque for a row, which makes everything else half a row late. A delay of two samples
// exceeds the uncertainty of sampling instants, so no tolerance may absorb it.
TEST(DiagnoseLate, ADriveOutOfTimeIsNamedWithAnIntervalNoNarrowerThanSampling) {
  auto recordings = swings(no_torque, 1, 10);
  for (auto& trial : recordings.trials) trial.channels.erase("velocity_radps");
  make_late(recordings, "torque_Nm", 2);
  const auto d = diagnose(recordings);
  ASSERT_EQ(d.verdict, Verdict::missing_physics);
  ASSERT_EQ(d.effects.size(), 1u);
  const auto& found = d.effects.front();
  EXPECT_TRUE(found.id == "clock.skew" || found.id == "actuator.delay") << found.id;
  EXPECT_GT(found.probability, 0.8);
  const auto& late = found.parameters.front();
  EXPECT_NEAR(std::abs(late.value), 1.5 * kRow_s, 1e-3);
  EXPECT_GT(late.high - late.low, 2.0 * 0.29 * kRow_s);  // 0.29: standard deviation of an instant that is
                                                         // uniform within a row
}

// An equal delay of torque and position would be an equivalent explanation.
TEST(DiagnoseLate, AVelocityThatIsEarlyIsOneSkew) {
  auto recordings = swings(no_torque, 1, 10);
  make_late(recordings, "velocity_radps", -2);
  const auto d = diagnose(recordings);
  ASSERT_EQ(d.verdict, Verdict::missing_physics);
  ASSERT_EQ(d.effects.size(), 1u);
  EXPECT_EQ(d.effects.front().id, "clock.skew");
  EXPECT_EQ(d.effects.front().channel, "velocity_radps");
  EXPECT_NEAR(d.effects.front().parameters.front().value, -1.5 * kRow_s, 1e-3);
}

// Position late against force, or force early: the recorded velocity decides.
TEST(DiagnoseLate, OfAnIntrudersTwoChannelsTheOneThatIsLateIsNamed) {
  const auto bed = [](double, double) { return 0.0; };
  for (const std::string channel : {"foot_z_m", "force_N"}) {
    auto recordings = presses(bed);
    make_late(recordings, channel, 2);
    const auto d = diagnose(recordings);
    ASSERT_EQ(d.verdict, Verdict::missing_physics) << channel;
    const auto skew =
        std::ranges::find_if(d.effects, [](const FoundEffect& e) { return e.id == "clock.skew"; });
    ASSERT_NE(skew, d.effects.end()) << channel;
    EXPECT_EQ(skew->channel, channel);
    EXPECT_NEAR(skew->parameters.front().value, 2.0 * kPressRow_s, 5e-4);
  }
}

// An axis is not simulated while its torque is unknown, because an interpolated torque is not the true one.
TEST(DiagnoseGaps, AnAxisWhoseTorqueIsUnknownForAWhileShowsNothing) {
  auto recordings = swings(no_torque);
  const auto whole = diagnose(recordings);
  for (auto& trial : recordings.trials) {
    auto& torque = trial.channels["torque_Nm"];
    for (const std::size_t from : {150u, 300u, 450u})  // 0.24 s each; the drive's period is 2.5 s
      for (std::size_t i = from; i < from + 60; ++i) torque[i] = std::nan("");
  }
  const auto d = diagnose(recordings);
  for (const auto& found : d.effects) EXPECT_EQ(found.id, "data.dropout");
  ASSERT_EQ(d.fits.size(), whole.fits.size());
  for (std::size_t c = 0; c < d.fits.size(); ++c)
    EXPECT_LT(d.fits[c].heldout.after, 1.1 * whole.fits[c].heldout.after) << d.fits[c].channel;
}

// y = F - m a with a upwards: a mass beyond the cell has a positive sign.
TEST(DiagnoseLoadCell, AMassBeyondItIsPositive) {
  auto recordings = presses([](double, double) { return 0.0; });
  for (auto& trial : recordings.trials) {
    auto& force = trial.channels["force_N"];
    for (std::size_t i = 0; i < force.size(); ++i) force[i] -= 0.15 * trial.channels["foot_accel_mps2"][i];
  }
  const auto d = diagnose(recordings);
  ASSERT_EQ(d.verdict, Verdict::missing_physics);
  ASSERT_EQ(d.effects.size(), 1u);
  EXPECT_EQ(d.effects.front().id, "load_cell.inertia");
  EXPECT_NEAR(d.effects.front().parameters.front().value, 0.15, 0.01);
}

// In twelve trials a clock that is fast by 3e-4 is significant with p near 0.02 over all candidates, one by
// 5e-4 with p < 1e-3.
TEST(DiagnoseSmall, WhatIsBarelyThereIsNamedAloneButNotConfidently) {
  const auto with_fast_clock = [](double drift) {
    auto recordings = drops(no_force, 7, 12);
    for (auto& trial : recordings.trials) {
      trial.channels.erase("accel_mps2");
      for (double& t : trial.time_s) t *= 1.0 + drift;
    }
    return diagnose(recordings);
  };
  const auto barely = with_fast_clock(3e-4);
  ASSERT_EQ(barely.effects.size(), 1u);
  EXPECT_EQ(barely.effects.front().id, "clock.drift");
  EXPECT_GT(barely.effects.front().p_value, 0.01);
  EXPECT_LT(barely.effects.front().p_value, 0.05);
  EXPECT_LT(barely.effects.front().probability, 0.8);
  const auto clearly = with_fast_clock(5e-4);
  ASSERT_EQ(clearly.effects.size(), 1u);
  EXPECT_EQ(clearly.effects.front().id, "clock.drift");
  EXPECT_LT(clearly.effects.front().p_value, 0.01);
  EXPECT_GT(clearly.effects.front().probability, 0.8);
}

TEST(DiagnoseSmall, ADragOfATwentiethOfItsTypicalSizeIsNoUnknown) {
  const auto d =
      diagnose(drops([](double, double, double v) { return -0.5 * 1.2 * 0.01 * 0.025 * std::abs(v) * v; }));
  ASSERT_EQ(d.verdict, Verdict::missing_physics);
  ASSERT_EQ(d.effects.size(), 1u);
  EXPECT_EQ(d.effects.front().id, "air.quadratic_drag");
  EXPECT_NEAR(d.effects.front().parameters.front().value, 0.025, 0.005);
}

// In free fall an accelerometer shows only noise, which does not bound its offset.
TEST(DiagnoseSmall, AFallingAccelerometerMayBeOffByMoreThanItShows) {
  auto recordings = drops(no_force);
  for (auto& trial : recordings.trials)
    for (double& a : trial.channels["accel_mps2"]) a -= 0.4;
  const auto d = diagnose(recordings);
  ASSERT_EQ(d.verdict, Verdict::missing_physics);
  ASSERT_EQ(d.effects.size(), 1u);
  EXPECT_EQ(d.effects.front().id, "imu.bias");
  EXPECT_EQ(d.effects.front().indistinguishable_from, std::vector<std::string>{"sensor.bias"});
  EXPECT_NEAR(d.effects.front().parameters.front().value, -0.4, 0.02);
}

// In a fall successive samples differ by 50 steps or more, so three equal ones are no chance.
TEST(DiagnoseSmall, ThreeHeightsAlikeInAFallWereHeld) {
  auto recordings = drops(no_force);
  for (auto& trial : recordings.trials) {
    auto& height = trial.channels["height_m"];  // fills every other row
    for (double& h : height) h = std::round(1e4 * h) / 1e4;
    const std::size_t at = height.size() / 2 / 2 * 2;
    height[at + 2] = height[at + 4] = height[at];
  }
  const auto d = diagnose(recordings);
  const auto stuck =
      std::ranges::find_if(d.effects, [](const FoundEffect& e) { return e.id == "data.stuck"; });
  ASSERT_NE(stuck, d.effects.end());
  EXPECT_EQ(stuck->channel, "height_m");
  EXPECT_EQ(d.effects.size(), 1u);
}

// At a turning point the torque itself rests, but noise of two steps does not rest for fifteen samples.
TEST(DiagnoseSmall, WhatIsHeldAtATurnIsSeenByItsNoise) {
  constexpr double kStep_Nm = 0.05;
  constexpr std::ptrdiff_t kHalf = 7;
  auto recordings = swings(no_torque);
  Random random(5, 0);
  for (auto& trial : recordings.trials) {
    auto& torque = trial.channels["torque_Nm"];
    const auto [least, most] = std::minmax_element(torque.begin() + 20, torque.end() - 20);
    const auto low = least - torque.begin(), high = most - torque.begin();
    for (double& value : torque) value = kStep_Nm * std::round(value / kStep_Nm + 2.0 * random.normal());
    for (const auto turn : {low, high})
      std::fill(torque.begin() + turn - kHalf, torque.begin() + turn + kHalf + 1,
                torque[static_cast<std::size_t>(turn)]);
  }
  const auto d = diagnose(recordings);
  const auto stuck =
      std::ranges::find_if(d.effects, [](const FoundEffect& e) { return e.id == "data.stuck"; });
  ASSERT_NE(stuck, d.effects.end());
  // One of the ten lies at the end of the range, where a sensor may rest at its limit.
  EXPECT_NE(stuck->statement.find("held one value 9 times"), std::string::npos) << stuck->statement;
}

}  // namespace
}  // namespace sandhopper::diagnose
