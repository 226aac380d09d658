#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/campaign_folder.hpp"
#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/campaign/belief_sources.hpp"

// Numbers of the belief that differ from trial to trial, as [spread] states them.
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
  EXPECT_EQ(belief.key_spreads[0].key, "axis.coulomb_friction_Nm");
  EXPECT_EQ(belief.key_spreads[0].sd, 0.05);
  EXPECT_TRUE(belief.key_spreads[0].is_relative);
  EXPECT_EQ(belief.key_spreads[1].key, "axis.viscous_friction_Nm_s");
  EXPECT_EQ(belief.key_spreads[2].key, "axis.inertia_kg_m2");
  EXPECT_FALSE(belief.key_spreads[2].is_relative);
  EXPECT_EQ(belief.spread.other.torque_offset_Nm, 0.01);  // the plant's own keys stay the plant's own
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

}  // namespace

namespace diagnose {
namespace {

// A pendulum whose Coulomb friction of 0.06 N m is believed, and differs by 10 % from trial to trial.
Recordings with_friction_that_varies() {
  auto friction_Nm = [trial = -1, random = Random(41, 0), size_Nm = 0.0, before = 1e9](
                         double angle, double speed, double) mutable {
    // A trial begins at rest.
    if (speed == 0.0 && before != 0.0 && angle != 0.0) {
      ++trial;
      size_Nm = 0.06 * (1.0 + 0.1 * random.normal());
    }
    before = speed;
    return -size_Nm * std::tanh(speed / 0.02);
  };
  auto recordings = swings(friction_Nm, 40, 10);
  recordings.belief.numbers["axis.coulomb_friction_Nm"] = 0.06;
  for (auto& belief : recordings.beliefs) belief = recordings.belief;
  return recordings;
}

TEST(DiagnoseKeySpread, FrictionThatVariesAsBelievedIsNothingMissing) {
  auto recordings = with_friction_that_varies();
  EXPECT_NE(diagnose(recordings).verdict, Verdict::consistent);
  recordings.belief.key_spreads = {{"coulomb_friction_relative", "axis.coulomb_friction_Nm", 0.1, true}};
  for (auto& belief : recordings.beliefs) belief = recordings.belief;
  const auto d = diagnose(recordings);
  EXPECT_EQ(d.verdict, Verdict::consistent);
  EXPECT_TRUE(d.effects.empty());
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

}  // namespace
}  // namespace diagnose
}  // namespace sandhopper
