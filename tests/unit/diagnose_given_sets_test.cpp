#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "tools/diagnose/answer/diagnosis_text.hpp"
#include "tools/diagnose/engine.hpp"
#include "tools/diagnose/recordings/campaign_input.hpp"

namespace sandhopper::diagnose {
namespace {

// Recordings of other laboratories with a physicist's answer (given_real_sets.md): effects that must be
// named, bounds, and the least improvement on held-out trials.
class DiagnoseGivenSets : public ::testing::Test {
 protected:
  // Prints a warning and returns false if the recordings do not exist.
  bool run(const std::string& name) {
    const auto folder = std::filesystem::path(SANDHOPPER_SOURCE_DIR).parent_path() / "shared/data" / name;
    if (!std::filesystem::exists(folder / "campaign.toml")) {
      std::printf("*** SKIPPED: %s is not there; put the recordings beside this repository ***\n",
                  folder.c_str());
      return false;
    }
    answer_ = diagnose(read_campaign(load_campaign(folder)).recordings);
    return true;
  }
  bool names(const std::string& id) const {
    return std::ranges::any_of(answer_.effects,
                               [&](const auto& e) { return e.id == id && e.probability > 0.5; });
  }
  double value(const std::string& id) const {
    const auto it = std::ranges::find(answer_.effects, id, &FoundEffect::id);
    return it == answer_.effects.end() ? std::nan("") : it->parameters.front().value;
  }
  double surest_unknown() const {
    double most = 0.0;
    for (const auto& e : answer_.effects)
      if (e.is_unknown()) most = std::max(most, e.probability);
    return most;
  }
  double share_of_error_left() const {
    const auto& error = answer_.fits.front().heldout;
    return error.after / error.before;
  }
  Diagnosis answer_;
};

TEST_F(DiagnoseGivenSets, AThrownPhoneIsSlowedByTheSquareOfItsSpeed) {
  if (!run("phone_throws")) GTEST_SKIP();
  EXPECT_EQ(answer_.verdict, Verdict::missing_physics);
  ASSERT_TRUE(names("air.quadratic_drag")) << to_text(answer_);
  EXPECT_GT(value("air.quadratic_drag"), 0.045);
  EXPECT_LT(value("air.quadratic_drag"), 0.054);
  EXPECT_FALSE(names("air.linear_drag"));
  EXPECT_LE(surest_unknown(), 0.5);
  EXPECT_GT(answer_.gap_closed, 0.9);
  EXPECT_LT(share_of_error_left(), 0.35);
}

TEST_F(DiagnoseGivenSets, ASphereThatEntersWaterTakesWaterAlong) {
  if (!run("water_entry_sphere")) GTEST_SKIP();
  constexpr double kDragPerCoefficient = 0.5 * 998.0 * 0.00155179;  // of 1 kg, in 1/m
  ASSERT_TRUE(names("air.quadratic_drag")) << to_text(answer_);
  EXPECT_GT(kDragPerCoefficient * value("air.quadratic_drag"), 0.13);
  EXPECT_LT(kDragPerCoefficient * value("air.quadratic_drag"), 0.42);
  ASSERT_TRUE(names("fluid.added_mass")) << to_text(answer_);
  EXPECT_GT(value("fluid.added_mass"), 0.007);
  EXPECT_LT(value("fluid.added_mass"), 0.015);
  EXPECT_LE(surest_unknown(), 0.5);
  EXPECT_LT(share_of_error_left(), 0.35);
}

// The drive is off and the torque is 0, so typical sizes come from gravity. Four trials contain three effects
// and a late velocity: friction of some kind, and inertia or gravity must be named.
TEST_F(DiagnoseGivenSets, AServoThatSwingsFreeHasFriction) {
  if (!run("servo_passive")) GTEST_SKIP();
  EXPECT_TRUE(names("axis.inertia") || names("axis.gravity")) << to_text(answer_);
  EXPECT_TRUE(names("axis.viscous") || names("axis.coulomb") || names("axis.load_dependent"))
      << to_text(answer_);
  EXPECT_FALSE(names("air.quadratic_drag"));
  EXPECT_FALSE(names("axis.torque_scale"));
  EXPECT_LE(surest_unknown(), 0.5);
  EXPECT_LT(share_of_error_left(), 0.5);
}

}  // namespace
}  // namespace sandhopper::diagnose
