#include "tools/diagnose/answer/diagnosis_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/diagnose/answer/diagnosis.hpp"

namespace sandhopper::diagnose {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Diagnosis unknown(double heldout_before, double heldout_after) {
  Diagnosis d;
  d.verdict = Verdict::unknown_physics;
  d.fits.push_back(
      {.channel = "position_rad", .train = {}, .heldout = {heldout_before, heldout_after}, .floor = 1.0});
  return d;
}

// A column in degrees that is read as radians looks like physics that no law explains.
TEST(DiagnosisText, AGapOfWhichHalfIsLeftPointsAtUnitsAndColumnsFirst) {
  EXPECT_THAT(headline(unknown(20.0, 10.0)), HasSubstr("units"));
  EXPECT_THAT(headline(unknown(20.0, 9.9)), Not(HasSubstr("units")));
  EXPECT_THAT(to_text(unknown(20.0, 19.0)), HasSubstr("hop campaign check"));
}

FoundEffect found(const char* id, double probability) {
  FoundEffect effect;
  effect.id = id;
  effect.probability = probability;
  effect.parameters = {{"size", 1.0, 0.9, 1.1, false}};
  return effect;
}

TEST(DiagnosisText, AnEffectThatIsMoreLikelyNotThereIsAGuessInTheHeadline) {
  Diagnosis d;
  d.verdict = Verdict::missing_physics;
  d.detail = Detail::known;
  d.effects = {found("axis.coulomb", 0.95), found("axis.viscous", 0.34)};
  EXPECT_EQ(headline(d), "Something is missing: axis.coulomb, perhaps axis.viscous.");
  d.effects.back().probability = 0.5;
  EXPECT_EQ(headline(d), "Something is missing: axis.coulomb, axis.viscous.");
  d.effects = {found("axis.viscous", 0.34)};
  EXPECT_EQ(headline(d), "Something is missing: perhaps axis.viscous.");
}

// A bias whose interval was -0.3 to 0.5 mm stood in the headline beside two effects that were found.
TEST(DiagnosisText, AnEffectWhoseIntervalHoldsZeroIsNoFindingInTheHeadline) {
  Diagnosis d;
  d.verdict = Verdict::missing_physics;
  d.detail = Detail::known;
  d.effects = {found("terrain.crust", 0.7), found("sensor.bias", 0.7)};
  EXPECT_EQ(headline(d), "Something is missing: terrain.crust, sensor.bias.");
  d.effects.back().parameters = {{"bias_m", 0.00009, -0.00034, 0.00052, false}};
  EXPECT_EQ(headline(d), "Something is missing: terrain.crust, perhaps sensor.bias.");
  d.effects = {d.effects.back()};
  EXPECT_EQ(headline(d), "Something may be missing: sensor.bias; its 95 % interval holds zero.");
}

// The tables have the channel's unit, so the sentences beside them have it, too.
TEST(DiagnosisText, NoiseAndLimitsStandInTheUnitOfTheTables) {
  SensorNoise noise{
      .channel = "height_m", .stated = 0.004, .source = "", .measured = 0.00507, .used = 0.00531};
  EXPECT_THAT(noise.in_words(), HasSubstr("0.00531 m, 1.3 times the 0.004 m stated"));
  EXPECT_THAT(noise.in_words(), Not(HasSubstr("mm")));
  FoundParameter depth{"crust_depth_m", 0.0002, 0.0002, 0.00045, false};
  depth.limit = 0.0002;
  EXPECT_THAT(depth.limit_in_words(), HasSubstr("limit of 0.0002 m"));
}

TEST(DiagnosisText, WithNothingFoundThereIsOneErrorAndNoBeforeAndAfter) {
  Diagnosis d = unknown(2.0, 2.0);
  d.verdict = Verdict::consistent;
  EXPECT_THAT(to_text(d), HasSubstr("position_rad: 2.0 times the noise floor on held-out trials"));
  EXPECT_THAT(to_text(d), Not(HasSubstr("before")));
  d.verdict = Verdict::missing_physics;
  d.effects = {found("axis.coulomb", 0.9)};
  EXPECT_THAT(to_text(d), HasSubstr("2.0 times the noise floor before, 2.0 after"));
}

Diagnosis with_noise(double stated, double measured, double used) {
  Diagnosis d;
  d.noise = {{.channel = "position_rad",
              .stated = stated,
              .source = stated > 0.0 ? "nominal.toml, line 5" : "",
              .measured = measured,
              .used = used,
              .is_raised = true,
              .is_sensor_worse = stated > 0.0 && measured > stated}};
  return d;
}

// A stranger found only in the log of the search that the noise had been raised.
TEST(DiagnosisText, ARaisedNoiseStandsWithItsSizesAndWhatItMeans) {
  const auto remainder = to_text(with_noise(0.1, 0.1, 0.21));
  EXPECT_THAT(
      remainder,
      HasSubstr("noise  position_rad: 0.21 rad, 2.1 times the 0.1 rad stated (nominal.toml, line 5)"));
  EXPECT_THAT(remainder, HasSubstr("an error of the model"));
  const auto worse = to_text(with_noise(0.1, 0.2, 0.21));
  EXPECT_THAT(worse, HasSubstr("the sensor is worse than stated"));
  EXPECT_THAT(to_text(with_noise(0.0, 0.1, 0.21)), HasSubstr("2.1 times the 0.1 rad by which it scatters"));
  auto usual = with_noise(0.1, 0.1, 0.11);
  usual.noise.front().is_raised = false;
  EXPECT_THAT(to_text(usual), Not(HasSubstr("noise  position_rad")));
}

// "1.0 times the noise floor" beside "missing_physics" looks like a contradiction.
TEST(DiagnosisText, AFindingBelowTheNoiseFloorIsExplained) {
  auto d = unknown(1.0, 0.4);
  d.verdict = Verdict::missing_physics;
  d.fits.front().noise = 0.5;
  d.effects = {found("terrain.depth_power_law", 0.98)};
  EXPECT_THAT(to_text(d), HasSubstr("noise floor 1, noise of a sample 0.5"));
  EXPECT_THAT(to_text(d), HasSubstr("No channel's error is clearly above its noise floor"));
  d.fits.front().heldout.before = 1.4;
  EXPECT_THAT(to_text(d), Not(HasSubstr("No channel's error")));
}

TEST(DiagnosisText, AParameterAtItsLimitIsMarked) {
  Diagnosis d;
  d.verdict = Verdict::missing_physics;
  d.effects = {found("sensor.lag", 0.9)};
  EXPECT_THAT(to_text(d), Not(HasSubstr("at its limit")));
  d.effects.front().parameters = {
      {.name = "bandwidth_Hz", .value = 60.0, .low = 40.0, .high = 60.0, .limit = 60.0}};
  EXPECT_THAT(to_text(d), HasSubstr("at its limit of 60 Hz: the true value may lie beyond"));
}

// "1.4 -> 1.6 times the noise floor" does not tell how much of the first gap is left.
TEST(DiagnosisText, WhatRemainsStandsInTheChannelsUnitAndAgainstTheFirstModel) {
  auto d = unknown(1.25, 1.25);
  d.effects = {found("unknown@axis", 0.5)};
  d.fits.front().range = 75.0;
  EXPECT_THAT(to_text(d),
              HasSubstr("left   position_rad: what remains is 0.75 rad rms beyond the noise floor, 1.0 % "
                        "of the range of 75 rad.\n"));
  d.first = FirstAnswer{"answer/diagnosis.json", {{"position_rad", 25.0}}};
  EXPECT_THAT(headline(d), HasSubstr("beside what the corrected model contains"));
  EXPECT_THAT(headline(d),
              HasSubstr("and 3.0 % of the 25 rad that the first model left (answer/diagnosis.json)"));
  EXPECT_THAT(headline(d), Not(HasSubstr("units")));
  d.fits.front().heldout.after = 0.9;
  EXPECT_THAT(headline(d), HasSubstr("not larger than the noise floor"));
}

}  // namespace
}  // namespace sandhopper::diagnose
