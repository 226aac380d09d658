#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/campaign_folder.hpp"
#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/campaign/belief_sources.hpp"
#include "tools/diagnose/fit/linearise.hpp"
#include "tools/diagnose/fit/prepare.hpp"

// Numbers of the belief with a spread from trial to trial, as [spread] states it.
namespace sandhopper {
namespace {

struct Read {
  RotaryAxisBelief belief{};
  std::vector<Finding> notes{};
  std::vector<UnstatedNumber> unstated{};
};
Read read(const std::string& spread) {
  CampaignFolder folder;
  folder.write("nominal.toml",
               "[axis]\ninertia_kg_m2 = 0.1\ncoulomb_friction_Nm = 0.05\n"
               "viscous_friction_Nm_s = 0.02\n[spread]\n" +
                   spread);
  Read out;
  out.belief = std::get<RotaryAxisBelief>(
      load_belief(folder.path() / "nominal.toml", CampaignPlant::rotary_axis, out.notes, out.unstated));
  return out;
}

TEST(KeySpread, NamesANumberByItsQuantityOrByItsKey) {
  const auto [belief, notes, unstated] = read(
      "coulomb_friction_relative = 0.05\nviscous_friction_relative = 0.03\ninertia_kg_m2 = 0.002\n"
      "torque_offset_Nm = 0.01\n");
  EXPECT_TRUE(notes.empty());
  ASSERT_EQ(belief.key_spreads.size(), 3u);
  const auto named = [&](const std::string& name) {
    return *std::ranges::find(belief.key_spreads, name, &KeySpread::name);
  };
  EXPECT_EQ(named("coulomb_friction_relative").key, "axis.coulomb_friction_Nm");
  EXPECT_EQ(named("coulomb_friction_relative").sd, 0.05);
  EXPECT_TRUE(named("coulomb_friction_relative").is_relative);
  EXPECT_EQ(named("viscous_friction_relative").key, "axis.viscous_friction_Nm_s");
  EXPECT_EQ(named("inertia_kg_m2").key, "axis.inertia_kg_m2");
  EXPECT_FALSE(named("inertia_kg_m2").is_relative);
  EXPECT_EQ(belief.spread.other.torque_offset_Nm, 0.01);  // a key of the plant's own [spread] keeps its
                                                          // meaning
  EXPECT_EQ(numbers_of(Belief(belief)).at("spread.coulomb_friction_relative"), 0.05);
}

TEST(KeySpread, WhatNamesNothingIsLeftOutWithANote) {
  const auto [belief, notes, unstated] = read("friction_relative = 0.05\nposition_noise_relative = 0.1\n");
  EXPECT_TRUE(belief.key_spreads.empty());
  EXPECT_EQ(notes.size(), 2u);
}

TEST(KeySpread, ANegativeStandardDeviationIsRefused) {
  EXPECT_THROW(read("coulomb_friction_relative = -0.05\n"), ConfigError);
  EXPECT_THROW(read("coulomb_friction_relative = \"a lot\"\n"), ConfigError);
}

// [known_to] names numbers in the same way. A name that means none is an error: nobody else's tool writes it.
TEST(KnownTo, NamesANumberOfTheBelief) {
  const auto [belief, notes, unstated] = read("[known_to]\ninertia_relative = 0.015\n");
  ASSERT_EQ(belief.known_to.size(), 1u);
  EXPECT_EQ(belief.known_to.front().key, "axis.inertia_kg_m2");
  EXPECT_TRUE(belief.known_to.front().is_relative);
  EXPECT_EQ(numbers_of(Belief(belief)).at("known_to.inertia_relative"), 0.015);
  EXPECT_THROW(read("[known_to]\ninertia_relativ = 0.015\n"), ConfigError);
  EXPECT_THROW(read("[known_to]\ninertia_relative = -1\n"), ConfigError);
}

}  // namespace

namespace diagnose {
namespace {

// The belief has a friction of 0.06 N m, the recorded trial 0.09 N m.
TEST(DiagnoseKeySpread, AddsANuisanceThatMovesTheNumber) {
  auto recordings = swings([](double, double w, double) { return -0.09 * std::tanh(w / 0.02); }, 41, 4);
  recordings.belief.numbers["axis.coulomb_friction_Nm"] = 0.06;
  recordings.belief.key_spreads = {{"coulomb_friction_relative", "axis.coulomb_friction_Nm", 0.5, true}};
  for (auto& belief : recordings.beliefs) belief = recordings.belief;
  const auto prepared = prepare(recordings);
  const TrialModel& trial = *prepared.problem.trials.front();
  ASSERT_FALSE(trial.trial_nuisances.empty());
  const std::size_t at = trial.trial_nuisances.size() - 1;
  EXPECT_EQ(trial.trial_nuisances[at].name, "coulomb_friction_relative");
  EXPECT_EQ(trial.trial_nuisances[at].sd, 0.5);
  std::vector<double> nuisances(trial.nuisance_count(), 0.0);
  const auto squares = [&](double moved) {
    nuisances[at] = moved;
    return residual_of(trial, predicted(prepared.problem, trial, {}, nuisances)).squaredNorm();
  };
  EXPECT_LT(squares(0.5), 0.5 * squares(0.0));
  EXPECT_LT(squares(0.5), squares(1.0));
}

TEST(DiagnoseKeySpread, ANumberThatIsZeroHasNoShareToDifferBy) {
  auto recordings = swings([](double, double, double) { return 0.0; }, 43, 4);
  const auto plain = prepare(recordings).problem.trials.front()->nuisance_count();
  recordings.belief.key_spreads = {{"coulomb_friction_relative", "axis.coulomb_friction_Nm", 0.5, true}};
  for (auto& belief : recordings.beliefs) belief = recordings.belief;
  EXPECT_EQ(prepare(recordings).problem.trials.front()->nuisance_count(), plain);
}

TEST(DiagnoseKeySpread, WhatIsMissingBesideItIsStillFound) {
  auto recordings = swings([](double, double w, double) { return -0.09 * std::tanh(w / 0.02); }, 42, 8);
  recordings.belief.numbers["axis.coulomb_friction_Nm"] = 0.06;
  recordings.belief.key_spreads = {{"coulomb_friction_relative", "axis.coulomb_friction_Nm", 0.05, true}};
  for (auto& belief : recordings.beliefs) belief = recordings.belief;
  const auto d = diagnose(recordings);
  ASSERT_FALSE(d.effects.empty());
  EXPECT_EQ(d.effects.front().id, "axis.coulomb");
}

// An axis whose friction is 0.09 N m in all trials, believed to be 0.06 N m.
Diagnosis of_rough_swings(double known_to) {
  auto recordings = swings([](double, double w, double) { return -0.09 * std::tanh(w / 0.02); }, 44, 8);
  recordings.belief.numbers["axis.coulomb_friction_Nm"] = 0.06;
  recordings.belief.known_to = {{"coulomb_friction_relative", "axis.coulomb_friction_Nm", known_to, true}};
  for (auto& belief : recordings.beliefs) belief = recordings.belief;
  return diagnose(recordings, {.belief = {{.key = "axis.coulomb_friction_Nm", .low = 0.06, .high = 0.06}}});
}

// A number that is the same in all trials and known to 30 % only may be off by 50 %: nothing is missing, and
// the answer says what the recordings ask for. Known to 5 %, it may not.
TEST(DiagnoseKnownTo, ANumberThatMayBeOffIsFittedForAllTrialsTogether) {
  const auto open = of_rough_swings(0.3);
  EXPECT_EQ(open.verdict, Verdict::consistent);
  ASSERT_FALSE(open.belief.empty());
  EXPECT_NEAR(open.belief.front().known_sd, 0.3 * 0.06, 1e-12);
  EXPECT_NEAR(open.belief.front().asked_for, 0.03, 0.004);
  const auto held = of_rough_swings(0.05);
  ASSERT_FALSE(held.effects.empty());
  EXPECT_EQ(held.effects.front().id, "axis.coulomb");
}

// Presses whose load cell reads 10 % too little, in a bed whose stiffness is known this well.
Diagnosis of_weak_readings(std::vector<KeySpread> known_to) {
  auto recordings = presses([](double, double) { return 0.0; }, 45, 6);
  for (auto& trial : recordings.trials)
    for (double& force_N : trial.channels.at("force_N")) force_N *= 0.9;
  recordings.belief.known_to = std::move(known_to);
  for (auto& belief : recordings.beliefs) belief.known_to = recordings.belief.known_to;
  return diagnose(recordings);
}

bool is_named(const Diagnosis& d, const std::string& id) {
  return std::ranges::any_of(d.effects, [&](const FoundEffect& e) {
    return e.id == id || std::ranges::find(e.indistinguishable_from, id) != e.indistinguishable_from.end();
  });
}

// A weak bed and a weak reading look alike. What is known of the bed decides between them.
TEST(DiagnoseKnownTo, SettlesAClass) {
  const auto open = of_weak_readings({});
  EXPECT_TRUE(is_named(open, "terrain.stiffness"));
  EXPECT_TRUE(is_named(open, "load_cell.gain"));
  const auto known = of_weak_readings({{"stiffness_relative", "terrain.stiffness_N_per_m", 0.01, true}});
  EXPECT_FALSE(is_named(known, "terrain.stiffness"));
  EXPECT_TRUE(is_named(known, "load_cell.gain"));
}

}  // namespace
}  // namespace diagnose
}  // namespace sandhopper
