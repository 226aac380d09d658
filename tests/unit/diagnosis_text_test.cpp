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

}  // namespace
}  // namespace sandhopper::diagnose
