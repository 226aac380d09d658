#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/diagnose/open_world.hpp"

namespace sandhopper::diagnose {
namespace {

// 0.8 Nm sin(2 theta) throws the axis onto another course within half a second: what it does to the angle is
// no multiple of its size, and one linear step does not find that.
TEST(DiagnoseLawFit, ALawOfFreeFormIsFittedThroughTheSimulation) {
  constexpr double kScale_Nm = 0.5, kTorque_Nm = 0.8;
  const Problem problem =
      prepare(swings([](double angle, double, double) { return kTorque_Nm * std::sin(2.0 * angle); }, 1, 6))
          .problem;
  const Fit null = fit_from(problem, null_point(problem));
  FreeGain law;
  law.family.terms = {
      {"axis", false, [](const PortState& s) { return kScale_Nm * std::sin(2.0 * s.position); }, kScale_Nm}};
  law.size = law.sd = Eigen::VectorXd::Zero(1);
  const Point point = with_law_fitted(problem, null, law);
  ASSERT_EQ(point.hypothesis.law_sizes.size(), 1u);
  EXPECT_NEAR(law.size[0] * kScale_Nm, kTorque_Nm, 0.03 * kTorque_Nm);
  EXPECT_GT(law.sd[0], 0.0);
  EXPECT_LT(law.sd[0], 0.03);
  EXPECT_EQ(point.hypothesis.law_sizes.front(), law.size[0]);
  EXPECT_LT(deviance_of(problem, point, problem.channels),
            0.05 * deviance_of(problem, null.point, problem.channels));
}

}  // namespace
}  // namespace sandhopper::diagnose
