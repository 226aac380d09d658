#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/diagnose_free_swings.hpp"
#include "tools/diagnose/answer/diagnosis_text.hpp"
#include "tools/diagnose/fit/prepare.hpp"

// The zero of the angle of an arm that hangs: set anew for each recording, or the same in all.
namespace sandhopper::diagnose {
namespace {

bool has_own_zero(const Recordings& recordings) {
  const auto prepared = prepare(recordings);
  return std::ranges::any_of(prepared.problem.trials.front()->trial_nuisances,
                             [](const auto& one) { return one.name == "position_offset_rad"; });
}

Recordings with_own_zeros(Recordings recordings) {
  for (auto& belief : recordings.beliefs) belief.numbers["spread.position_offset_rad"] = 0.02;
  return recordings;
}

TEST(DiagnoseZeroOfAngle, DiffersOnlyIfTheBeliefSaysSo) {
  EXPECT_FALSE(has_own_zero(free_swings({})));
  EXPECT_TRUE(has_own_zero(with_own_zeros(free_swings({}))));
  auto without_gravity = with_own_zeros(free_swings({}));
  for (auto& belief : without_gravity.beliefs) belief.numbers["axis.gravity_torque_Nm"] = 0.0;
  EXPECT_FALSE(has_own_zero(without_gravity));
}

// A number that the belief lets differ from trial to trial is a nuisance behind this one.
TEST(DiagnoseZeroOfAngle, IsItsOwnBesideAKeyThatDiffers) {
  auto free = with_own_zeros(free_swings({}));
  for (auto& belief : free.beliefs) belief.key_spreads = {{"inertia_kg_m2", "axis.inertia_kg_m2", 0.001}};
  const auto prepared = prepare(free);
  const TrialModel& trial = *prepared.problem.trials.front();
  const auto& names = trial.trial_nuisances;
  const auto zero = std::ranges::find(names, "position_offset_rad", &Nuisance::name);
  ASSERT_NE(zero, names.end());
  ASSERT_GT(names.size(), 1U);
  std::vector<double> nuisances(trial.nuisance_count(), 0.0), before(trial.rows.size()), after(before);
  trial.predict(trial.with_key_spreads({}, nuisances), nuisances, before);
  // The reading is 0.01 rad larger at the same motion: the start is read, so its nuisance makes up for it.
  nuisances[static_cast<std::size_t>(zero - names.begin())] = 0.01;
  for (std::size_t b = 0; b < trial.blocks; ++b)
    nuisances[names.size() + b * trial.block_nuisances.size()] = 0.01;
  trial.predict(trial.with_key_spreads({}, nuisances), nuisances, after);
  for (std::size_t k = 0; k < before.size(); ++k)
    EXPECT_NEAR(after[k] - before[k], trial.rows[k].channel == 0 ? 0.01 : 0.0, 1e-9);
}

TEST(DiagnoseZeroOfAngle, TwoZerosDoNotHideFriction) {
  const auto d = diagnose(
      with_own_zeros(free_swings({.coulomb_Nm = 0.004, .zeros_rad = {-0.005, -0.005, -0.019, -0.019}})));
  EXPECT_EQ(d.verdict, Verdict::missing_physics) << to_text(d);
  ASSERT_EQ(d.effects.size(), 1u) << to_text(d);
  EXPECT_EQ(d.effects.front().id, "axis.coulomb") << to_text(d);
  EXPECT_NEAR(d.effects.front().parameters.front().value, 0.004, 0.0008);
}

TEST(DiagnoseZeroOfAngle, ACommonOffsetIsFound) {
  const auto d = diagnose(free_swings({.zeros_rad = {0.03, 0.03, 0.03, 0.03}}));
  ASSERT_EQ(d.effects.size(), 1u) << to_text(d);
  auto names = d.effects.front().indistinguishable_from;
  names.push_back(d.effects.front().id);
  EXPECT_TRUE(std::ranges::find(names, "encoder.offset") != names.end()) << to_text(d);
}

// Weaker gravity is not a constant torque and a large angle that cancel each other.
TEST(DiagnoseZeroOfAngle, WeakGravityIsNoTorqueThatTurnsAFreeArm) {
  const auto d = diagnose(free_swings({.gravity_torque_Nm = 1.97}));
  ASSERT_FALSE(d.effects.empty()) << to_text(d);
  for (const auto& effect : d.effects) {
    EXPECT_NE(effect.id, "axis.offset") << to_text(d);
    for (const auto& parameter : effect.parameters)
      EXPECT_NE(parameter.name, "torque_offset_Nm") << to_text(d);
  }
}

}  // namespace
}  // namespace sandhopper::diagnose
