#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/diagnose/discrepancy/open_world.hpp"

namespace sandhopper::diagnose {
namespace {

// Squared whitened residuals of all trials at a point.
double squares_at(const Problem& problem, const Point& point) {
  const Edits edits = edits_for(problem, point.hypothesis, point.tolerances);
  double sum = 0.0;
  for (std::size_t t = 0; t < problem.trials.size(); ++t) {
    const TrialModel& trial = *problem.trials[t];
    Eigen::VectorXd residual = residual_of(trial, predicted(problem, trial, edits, point.nuisances[t]));
    whiten(problem, t, residual);
    sum += residual.squaredNorm();
  }
  return sum;
}

// 0.8 N m sin(2 theta) changes the course of the axis within half a second. The change of the angle is not
// proportional to the law's size, so one linear step does not find it.
TEST(DiagnoseLawFit, ALawOfFreeFormIsFittedThroughTheSimulation) {
  constexpr double kScale_Nm = 0.5, kTorque_Nm = 0.8;
  const Problem problem =
      prepare(swings([](double angle, double, double) { return kTorque_Nm * std::sin(2.0 * angle); }, 1, 6))
          .problem;
  const Fit null = fit_from(problem, null_point(problem));
  FreeGain law;
  law.family.terms = {{"axis", false,
                       law_of([](const AxisState& s) { return kScale_Nm * std::sin(2.0 * s.angle_rad); }),
                       kScale_Nm}};
  law.size = law.sd = Eigen::VectorXd::Zero(1);
  const Point point = with_law_fitted(problem, null, law);
  ASSERT_EQ(point.hypothesis.law_sizes.size(), 1u);
  EXPECT_NEAR(law.size[0] * kScale_Nm, kTorque_Nm, 0.03 * kTorque_Nm);
  EXPECT_GT(law.sd[0], 0.0);
  EXPECT_LT(law.sd[0], 0.03);
  EXPECT_EQ(point.hypothesis.law_sizes.front(), law.size[0]);
  EXPECT_LT(squares_at(problem, point), 0.05 * squares_at(problem, null.point));
}

// A fit needs several iterations. It stops early if it cannot reach `of_use_below` any more, and continues if
// it can.
TEST(DiagnoseLawFit, WhatCannotComeNearIsGivenUp) {
  const Problem problem =
      prepare(swings([](double, double velocity, double) { return -0.08 * velocity; }, 1, 4)).problem;
  Point start = null_point(problem);
  for (std::size_t c = 0; c < problem.candidates.size(); ++c)
    if (problem.candidates[c].label() == "axis.viscous") {
      start.hypothesis.candidates = {c};
      start.hypothesis.values = {{0.3}};
    }
  ASSERT_EQ(start.hypothesis.candidates.size(), 1u);
  const Fit whole = fit_from(problem, start);
  ASSERT_EQ(whole.status, FitStatus::converged);
  EXPECT_NEAR(whole.point.hypothesis.values.front().front(), 0.08, 2e-3);
  const Fit given_up = fit_from(problem, start, {.of_use_below = -1e12});
  EXPECT_EQ(given_up.status, FitStatus::failed);
  EXPECT_LT(given_up.iterations, whole.iterations);
  const Fit of_use = fit_from(problem, start, {.of_use_below = whole.deviance + 1.0});
  EXPECT_EQ(of_use.deviance, whole.deviance);
}

}  // namespace
}  // namespace sandhopper::diagnose
