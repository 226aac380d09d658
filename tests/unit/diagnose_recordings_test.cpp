#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/unit/campaign_folder.hpp"
#include "tests/unit/shared_campaign.hpp"
#include "tools/diagnose/engine.hpp"
#include "tools/diagnose/recordings/campaign_input.hpp"

namespace sandhopper::diagnose {
namespace {

// The ready campaigns of other laboratories. The answer must be one that a physicist would accept, within
// bounds on both sides, and the error on held-out trials must fall.
class DiagnoseRecordings : public ::testing::Test {
 protected:
  // Prints a warning and returns false if the recordings do not exist.
  bool run(const std::string& name, std::size_t most_effects) {
    const auto campaign = shared_campaign(name);
    if (!campaign) return false;
    name_ = name;
    answer_ = run(*campaign, most_effects);
    return true;
  }
  static Diagnosis run(const Campaign& campaign, std::size_t most_effects) {
    EngineOptions options;
    options.most_effects = most_effects;
    return diagnose(read_campaign(campaign).recordings, options);
  }

  // The same recordings with the corrected model.
  Diagnosis again(std::size_t most_effects) const {
    namespace fs = std::filesystem;
    const fs::path source = fs::path(SANDHOPPER_SOURCE_DIR) / "config/campaigns" / name_;
    std::stringstream campaign;
    campaign << std::ifstream(source / "campaign.toml").rdbuf();
    // Finds the recordings from the original folder, because the copy of the campaign is elsewhere.
    ::setenv("SANDHOPPER_DATA", load_campaign(source).recordings.parent_path().c_str(), 1);
    CampaignFolder folder;
    folder.write("campaign.toml", campaign.str());
    folder.write("nominal.toml", answer_.corrected_model_toml);
    return run(load_campaign(folder.path()), most_effects);
  }

  const FoundEffect* found(const std::string& id) const {
    for (const auto& effect : answer_.effects)
      if (effect.id == id) return &effect;
    return nullptr;
  }
  double value(const std::string& id) const {
    const auto* effect = found(id);
    return effect == nullptr ? std::nan("") : effect->parameters.front().value;
  }
  double left_of_error() const {
    return answer_.fits.front().heldout.after / answer_.fits.front().heldout.before;
  }

  std::string name_;
  Diagnosis answer_;
};

TEST_F(DiagnoseRecordings, WhiffleBallFallsAgainstTheAir) {
  if (!run("whiffle_ball", 3)) GTEST_SKIP();
  ASSERT_EQ(answer_.verdict, Verdict::missing_physics);
  ASSERT_EQ(answer_.effects.size(), 1u);
  const auto& drag = answer_.effects.front();
  EXPECT_TRUE(drag.id == "air.linear_drag" || drag.id == "air.quadratic_drag") << drag.id;
  if (drag.id == "air.linear_drag") {
    EXPECT_GT(drag.parameters.front().value, 0.011);
    EXPECT_LT(drag.parameters.front().value, 0.017);
  }
  EXPECT_LT(left_of_error(), 0.5);
  EXPECT_GT(left_of_error(), 0.2);
  const auto second = again(3);
  EXPECT_TRUE(second.effects.empty()) << second.effects.front().id;
}

TEST_F(DiagnoseRecordings, VolleyballFallsAgainstTheAir) {
  if (!run("volleyball", 3)) GTEST_SKIP();
  ASSERT_FALSE(answer_.effects.empty());
  const auto& drag = answer_.effects.front();
  EXPECT_TRUE(drag.id == "air.linear_drag" || drag.id == "air.quadratic_drag") << drag.id;
  EXPECT_LT(left_of_error(), 0.95);
}

TEST_F(DiagnoseRecordings, HeavyBallsAreConsistentAndTheCameraIsNotBlamed) {
  if (!run("heavy_balls", 3)) GTEST_SKIP();
  EXPECT_EQ(answer_.verdict, Verdict::consistent);
  EXPECT_TRUE(answer_.effects.empty());
  const auto drag = std::find_if(answer_.absent.begin(), answer_.absent.end(),
                                 [](const Bound& bound) { return bound.id == "air.quadratic_drag"; });
  ASSERT_NE(drag, answer_.absent.end());
  EXPECT_EQ(drag->parameter, "drag_coefficient");
  EXPECT_GT(drag->value, 0.05);
  EXPECT_LT(drag->value, 2.0);
}

// Over these depths a power law and a bed that stiffens towards its floor are almost the same curve.
TEST_F(DiagnoseRecordings, PlatesMeetABedThatStiffensWithDepth) {
  if (!run("plates_on_springs", 3)) GTEST_SKIP();
  EXPECT_EQ(answer_.verdict, Verdict::missing_physics);
  ASSERT_TRUE(found("terrain.depth_power_law") != nullptr || found("terrain.floor_stiffening") != nullptr);
  // If both are found, each explains a part of the stiffening.
  if (found("terrain.depth_power_law") != nullptr && found("terrain.floor_stiffening") == nullptr) {
    EXPECT_GT(value("terrain.depth_power_law"), 1.2);
    EXPECT_LT(value("terrain.depth_power_law"), 1.45);
  }
  EXPECT_LT(left_of_error(), 0.8);
}

TEST_F(DiagnoseRecordings, PenetrometerFallsAgainstTheWater) {
  if (!run("penetrometer_on_spring", 3)) GTEST_SKIP();
  EXPECT_EQ(answer_.verdict, Verdict::missing_physics);
  EXPECT_GT(value("air.quadratic_drag"), 0.3);
  EXPECT_LT(value("air.quadratic_drag"), 1.1);
  EXPECT_LT(left_of_error(), 0.7);
}

TEST_F(DiagnoseRecordings, LegOnWoodHasInertiaAndFriction) {
  if (!run("hopper_on_wood", 3)) GTEST_SKIP();
  EXPECT_EQ(answer_.verdict, Verdict::missing_physics);
  EXPECT_GT(value("joint.rotor_inertia"), 1.0e-3);
  EXPECT_LT(value("joint.rotor_inertia"), 3.0e-3);
  EXPECT_LT(left_of_error(), 0.5);
}

}  // namespace
}  // namespace sandhopper::diagnose
