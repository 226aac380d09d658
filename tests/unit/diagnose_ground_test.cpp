#include <gtest/gtest.h>

#include <set>
#include <string>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/diagnose/plants/ground_laws.hpp"

// Effect of earlier pushes on a bed, and its unloading line.
namespace sandhopper::diagnose {
namespace {

// Two pushes lowered the surface by 10 mm each, so the floor at 60 mm is 40 mm below it.
TEST(DiagnoseGround, TheFloorStaysWhereItIsUnderACrater) {
  Edits edits;
  edits.law(LawPort::ground_surface, [](const GroundState& s) { return -0.01 * s.pushes; });
  edits.law(LawPort::ground_factor, [](const GroundState& s) { return s.bed_depth_m - s.depth_m; });
  const GroundLaws laws(edits, {.pushes = 2.0, .wait_s = 0.0, .bed_depth_m = 0.06});
  EXPECT_NEAR(laws.deeper_m(), -0.02, 1e-12);
  EXPECT_NEAR(laws.quasi_static_N(1.0, 0.03), 1.0 + 0.04 - 0.03, 1e-12);
}

// The true unloading line is a third as steep as the belief, and a mass lies beyond the load cell. A yielding
// rig and a gain would fit almost as well; making the believed line steeper changes nothing.
TEST(DiagnoseGround, ASofterUnloadingLineIsNotAYieldingRig) {
  constexpr double kMass_kg = 0.2;
  auto recordings = presses([](double, double) { return 0.0; });
  recordings.belief.numbers["terrain.unloading_stiffness_ratio"] = 90.0;
  for (auto& belief : recordings.beliefs) belief = recordings.belief;
  for (auto& trial : recordings.trials)
    for (std::size_t i = 0; i < trial.time_s.size(); ++i)
      trial.channels["force_N"][i] += kMass_kg * -trial.channels["foot_accel_mps2"][i];
  const auto d = diagnose(recordings);
  std::set<std::string> named;
  for (const auto& effect : d.effects) named.insert(effect.id);
  EXPECT_EQ(named, (std::set<std::string>{"load_cell.inertia", "terrain.unloading"}));
}

// The surface may lie 1 mm higher or lower in each trial, and a bias of the depth acts as a surface does that
// is off in all trials alike. Half of it must not become a crater.
TEST(DiagnoseGround, ABiasOfTheDepthIsNamedAlone) {
  constexpr double kBias_m = 0.005;
  auto recordings = presses([](double, double) { return 0.0; }, 5, 10);
  recordings.belief.numbers["spread.surface_height_m"] = 1e-3;
  for (auto& belief : recordings.beliefs) belief = recordings.belief;
  for (auto& trial : recordings.trials)
    for (double& z : trial.channels.at("foot_z_m")) z += kBias_m;
  const auto d = diagnose(recordings);
  ASSERT_EQ(d.effects.size(), 1u);
  EXPECT_EQ(d.effects.front().id, "sensor.bias");
  const auto& bias = d.effects.front().parameters.front();
  EXPECT_LT(bias.low, kBias_m);
  EXPECT_GT(bias.high, kBias_m);
}

// Every trial came after two pushes: a bed that they made stiffer is as good an explanation as a bed that is
// stiffer. On a bed that was prepared afresh each time it is none.
TEST(DiagnoseGround, AStifferBedMayBeACompactedOneIfEveryTrialCameAfterPushes) {
  const auto others_of = [](double pushes) {
    auto recordings = presses([](double, double) { return 0.0; }, 5, 8);
    for (auto& belief : recordings.beliefs) belief.numbers["terrain.stiffness_N_per_m"] *= 0.8;
    recordings.belief = recordings.beliefs.front();
    for (auto& trial : recordings.trials) trial.setup["pushes_since_preparation"] = pushes;
    const auto d = diagnose(recordings);
    std::set<std::string> names;
    for (const auto& effect : d.effects) {
      names.insert(effect.id);
      names.insert(effect.indistinguishable_from.begin(), effect.indistinguishable_from.end());
    }
    return names;
  };
  const auto after_pushes = others_of(2.0), afresh = others_of(0.0);
  EXPECT_TRUE(after_pushes.contains("terrain.stiffness"));
  EXPECT_TRUE(after_pushes.contains("terrain.compaction"));
  EXPECT_TRUE(afresh.contains("terrain.stiffness"));
  EXPECT_FALSE(afresh.contains("terrain.compaction"));
}

}  // namespace
}  // namespace sandhopper::diagnose
