#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tools/diagnose/next/bench_test.hpp"

namespace sandhopper::diagnose {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

// Candidates with these ids and channels, made of the registered effects.
class BenchTests : public ::testing::Test {
 protected:
  Candidate candidate(const std::string& id, const std::string& channel = "") const {
    const auto found = std::ranges::find_if(effects, [&](const Effect& e) { return e.id == id; });
    EXPECT_NE(found, effects.end()) << id;
    return {&*found, channel, {}, {}};
  }

  std::vector<Effect> effects = known_effects();
};

TEST_F(BenchTests, AreOneShortSentenceThatSaysWhatToDoAndWhatToLookAt) {
  const std::set<std::string> kinds{"",          "hop",  "intrusion", "drop", "motion",
                                    "air_sweep", "hold", "press",     "tap",  "clamped"};
  constexpr std::size_t kLongest = 210;
  for (const auto& effect : effects)
    for (const auto plant : effect.plants) {
      const BenchTest* test = bench_test_of(effect, plant);
      ASSERT_NE(test, nullptr) << effect.id;
      const auto text = sentence_of(*test, plant, "channel");
      EXPECT_TRUE(text.ends_with('.')) << text;
      EXPECT_EQ(std::ranges::count(text, '.'), 1) << text;
      EXPECT_NE(text.find(": "), std::string::npos) << text;
      EXPECT_EQ(std::ranges::count(text, ':'), 1) << text;
      EXPECT_EQ(text.find('{'), std::string::npos) << text;
      EXPECT_LE(text.size(), kLongest) << text;
      EXPECT_TRUE(kinds.contains(test->kind)) << effect.id << " has the kind " << test->kind;
    }
}

TEST_F(BenchTests, NameOnlyEffectsThatExist) {
  for (const auto& effect : effects)
    for (const auto& test : effect.bench_tests)
      for (const auto& other : test.same_for) EXPECT_EQ(candidate(other).effect->id, other) << effect.id;
}

TEST_F(BenchTests, AreOfThePlant) {
  const auto drag = candidate("air.quadratic_drag");
  EXPECT_THAT(bench_test_of(*drag.effect, PlantKind::falling_body)->sentence, HasSubstr("Tow the body"));
  EXPECT_EQ(bench_test_of(*drag.effect, PlantKind::rotary_axis)->kind, "motion");
  const auto stiffness = candidate("terrain.stiffness");
  const auto* test = bench_test_of(*stiffness.effect, PlantKind::hopper);
  EXPECT_THAT(sentence_of(*test, PlantKind::hopper, ""), HasSubstr("Press the foot"));
  EXPECT_THAT(sentence_of(*test, PlantKind::intruder, ""), HasSubstr("Press the plate"));
}

TEST_F(BenchTests, TheFoundEffectsTestIsRecommendedAndSaysForWhichNamesItDecides) {
  const std::vector<Candidate> candidates{candidate("body.mass"), candidate("actuator.temperature"),
                                          candidate("terrain.compaction")};
  const auto test = bench_test_for({"actuator.temperature", "body.mass", "terrain.compaction"}, candidates,
                                   PlantKind::hopper);
  ASSERT_TRUE(test);
  EXPECT_EQ(test->kind, "hop");
  EXPECT_EQ(test->order,
            "Record the same hop with cold and with warm motors, each on a freshly prepared bed");
  EXPECT_THAT(test->why, StartsWith(test->order + ": "));
  EXPECT_THAT(test->why,
              HasSubstr("It distinguishes actuator.temperature from body.mass and terrain.compaction."));
}

TEST_F(BenchTests, AWeighingIsNoRecording) {
  const auto test =
      bench_test_for({"body.mass", "actuator.torque_constant"},
                     {candidate("body.mass"), candidate("actuator.torque_constant")}, PlantKind::hopper);
  ASSERT_TRUE(test);
  EXPECT_EQ(test->kind, "");
  EXPECT_THAT(test->order, StartsWith("Weigh the body"));
}

// A freshly prepared bed undoes compaction and strengthening alike.
TEST_F(BenchTests, ATestThatShowsAllNamesAlikeIsLeftForThatOfARival) {
  const std::vector<Candidate> candidates{candidate("terrain.compaction"), candidate("terrain.strengthening"),
                                          candidate("clock.drift", "force_N")};
  const auto rivals =
      bench_test_for({"terrain.compaction", "terrain.strengthening"}, candidates, PlantKind::intruder);
  ASSERT_TRUE(rivals);
  EXPECT_THAT(rivals->why, HasSubstr("It distinguishes terrain.strengthening from terrain.compaction."));
  const auto own = bench_test_for({"terrain.compaction", "terrain.strengthening", "clock.drift[force_N]"},
                                  candidates, PlantKind::intruder);
  ASSERT_TRUE(own);
  EXPECT_THAT(own->why, HasSubstr("It distinguishes terrain.compaction from clock.drift[force_N], "
                                  "but not from terrain.strengthening."));
}

TEST_F(BenchTests, NameTheSensorsChannel) {
  const std::vector<Candidate> candidates{candidate("imu.tilt", "imu_body_accel_z_mps2"),
                                          candidate("imu.scale", "imu_body_accel_z_mps2")};
  const auto test = bench_test_for({"imu.tilt[imu_body_accel_z_mps2]", "imu.scale[imu_body_accel_z_mps2]"},
                                   candidates, PlantKind::hopper);
  ASSERT_TRUE(test);
  EXPECT_EQ(test->kind, "hold");
  EXPECT_THAT(test->why, HasSubstr("if imu_body_accel_z_mps2 is tilted"));
  EXPECT_THAT(test->why, Not(HasSubstr("{")));
}

TEST_F(BenchTests, ThereIsNoneForNamesThatNobodyListed) {
  EXPECT_FALSE(bench_test_for({"unknown@rail", "other@rail"}, {}, PlantKind::hopper));
}

}  // namespace
}  // namespace sandhopper::diagnose
