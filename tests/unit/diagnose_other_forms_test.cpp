#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/plant/random.hpp"

// Effects whose law has another form than in this project must get the same name.
namespace sandhopper::diagnose {
namespace {

double value_of(const FoundEffect& effect, const std::string& name) {
  const auto it = std::ranges::find(effect.parameters, name, &FoundParameter::name);
  return it == effect.parameters.end() ? std::nan("") : it->value;
}

TEST(DiagnoseOtherForms, FrictionThatNobodyBelievedInTurnsRoundInItsOwnWay) {
  const auto d =
      diagnose(swings([](double, double w, double) { return -0.06 * w / std::hypot(w, 0.05); }, 21, 8));
  ASSERT_EQ(d.effects.size(), 1u);
  EXPECT_EQ(d.effects.front().id, "axis.coulomb");
  EXPECT_NEAR(value_of(d.effects.front(), "coulomb_friction_Nm"), 0.06, 0.002);
}

TEST(DiagnoseOtherForms, StribeckFrictionMayFadeWithTheSquareOfSpeed) {
  const auto d = diagnose(swings(
      [](double, double w, double) { return -0.2 * std::tanh(w / 0.02) / (1.0 + std::pow(w / 0.3, 2)); }, 22,
      8));
  ASSERT_EQ(d.effects.size(), 1u);
  EXPECT_EQ(d.effects.front().id, "axis.stribeck");
  EXPECT_NEAR(value_of(d.effects.front(), "stribeck_torque_Nm"), 0.2, 0.01);
  EXPECT_NEAR(value_of(d.effects.front(), "stribeck_speed_radps"), 0.3, 0.03);
  EXPECT_NEAR(value_of(d.effects.front(), "tail"), 1.0, 0.3);
}

TEST(DiagnoseOtherForms, AnEccentricEncoderIsEccentricForTheVelocityAsWell) {
  for (const bool of_both : {false, true}) {
    auto recordings = swings([](double, double, double) { return 0.0; }, 23, 8);
    for (auto& trial : recordings.trials) {
      auto &angle = trial.channels["position_rad"], &speed = trial.channels["velocity_radps"];
      for (std::size_t i = 0; i < angle.size(); ++i) {
        if (of_both) speed[i] *= 1.0 + 0.02 * std::cos(angle[i] + 0.5);
        angle[i] += 0.02 * std::sin(angle[i] + 0.5);
      }
    }
    const auto d = diagnose(recordings);
    ASSERT_EQ(d.effects.size(), 1u) << of_both;
    EXPECT_EQ(d.effects.front().id, "encoder.eccentricity");
    EXPECT_NEAR(value_of(d.effects.front(), "part_of_velocity"), of_both ? 1.0 : 0.0, 0.1);
    const auto& amplitude = d.effects.front().parameters.front();
    EXPECT_EQ(amplitude.name, "eccentricity_rad");
    EXPECT_LT(amplitude.low, 0.02);
    EXPECT_GT(amplitude.high, 0.02);
    EXPECT_LT(amplitude.high - amplitude.low, 0.005);
  }
}

// The change of a believed number as a share of it comes first, then the number, then its change.
TEST(DiagnoseOtherForms, AnotherInertiaIsToldAsAShareOfTheBelievedOne) {
  constexpr double kShare = 0.05;
  auto recordings = swings([](double, double, double) { return 0.0; }, 26, 8);
  recordings.belief.numbers["axis.inertia_kg_m2"] /= 1.0 + kShare;
  const double believed = recordings.belief.numbers["axis.inertia_kg_m2"];
  for (auto& belief : recordings.beliefs) belief = recordings.belief;
  const auto d = diagnose(recordings);
  ASSERT_EQ(d.effects.size(), 1u);
  ASSERT_EQ(d.effects.front().id, "axis.inertia");
  const auto& told = d.effects.front().parameters;
  ASSERT_EQ(told.size(), 3u);
  EXPECT_EQ(told[0].name, "inertia_change_fraction");
  EXPECT_NEAR(told[0].value, kShare, 0.005);
  EXPECT_NEAR(told[1].value, believed * (1.0 + told[0].value), 1e-9);
  EXPECT_NEAR(told[2].value, believed * told[0].value, 1e-9);
  EXPECT_NEAR(told[0].high - told[0].value, (told[1].high - told[1].value) / believed, 1e-9);
}

// A bed that becomes stiffer with every push: this shows only in the stiffness, which may differ from trial
// to trial.
TEST(DiagnoseOtherForms, WhatShowsFromTrialToTrialOnlyIsNamed) {
  auto recordings = presses([](double, double) { return 0.0; }, 24, 9);
  recordings.belief.numbers["spread.bed_stiffness_relative"] = 0.03;
  for (std::size_t i = 0; i < recordings.trials.size(); ++i) {
    recordings.beliefs[i] = recordings.belief;
    auto& trial = recordings.trials[i];
    const double pushes = trial.setup["pushes_since_preparation"];
    Random random(25, i);
    for (double& force_N : trial.channels["force_N"])
      force_N = force_N * (1.0 + 0.3 * (1.0 - std::exp(-pushes / 2.0))) + 0.05 * random.normal();
  }
  const auto d = diagnose(recordings);
  ASSERT_FALSE(d.effects.empty());
  EXPECT_EQ(d.effects.front().id, "terrain.compaction");
  EXPECT_GT(d.effects.front().mass, 0.95);
}

// A force that varies in time, differently in each trial, correlates with no recorded quantity. A falling
// body has one port, so it acts there.
TEST(DiagnoseOtherForms, WhatGoesWithNothingActsAtThePlantsOnlyPort) {
  int trial = -1;
  double before_s = 1e9;
  const auto d = diagnose(drops([&](double t, double, double) {
    if (t < before_s) ++trial;
    before_s = t;
    return 0.1 * std::sin(6.2832 * 6.3 * t + 2.4 * trial * trial);
  }));
  EXPECT_EQ(d.verdict, Verdict::unknown_physics);
  EXPECT_TRUE(std::ranges::any_of(d.effects, [](const auto& e) { return e.id == "unknown@body"; }));
}

// Friction that differs from angle to angle: listed friction closes most of the gap, and several times the
// noise is left. A law of free form fitted without the names explains what they explain, too: that must not
// count as left.
TEST(DiagnoseOtherForms, ANameKeepsItsShareBesideWhatIsOnNoList) {
  const auto d = diagnose(swings(
      [](double angle, double w, double) { return -0.08 * w * (1.0 + std::sin(5.0 * angle)); }, 27, 6));
  EXPECT_EQ(d.verdict, Verdict::missing_physics);
  EXPECT_GE(d.effects.front().probability, 0.5);
  EXPECT_FALSE(d.effects.front().is_unknown());
  EXPECT_TRUE(
      std::ranges::any_of(d.effects, [](const auto& e) { return e.is_unknown() && e.probability <= 0.5; }));
}

}  // namespace
}  // namespace sandhopper::diagnose
