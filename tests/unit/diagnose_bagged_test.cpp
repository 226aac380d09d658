#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/unit/diagnose_free_swings.hpp"
#include "tests/unit/diagnose_prepared.hpp"
#include "tools/diagnose/evidence/bagged.hpp"
#include "tools/diagnose/evidence/log_evidence.hpp"
#include "tools/diagnose/evidence/search.hpp"
#include "tools/diagnose/fit/fit.hpp"

// Masses of sets of effects, averaged over resampled trials.
namespace sandhopper::diagnose {
namespace {

// The fit of one effect by itself, from its typical size with this sign.
SetFit fitted(const Problem& problem, const std::string& name, double sign = 1.0) {
  SetFit out;
  const auto found =
      std::ranges::find_if(problem.candidates, [&](const Candidate& c) { return c.label() == name; });
  EXPECT_NE(found, problem.candidates.end()) << name;
  out.set = {static_cast<std::size_t>(found - problem.candidates.begin())};
  Point start = null_point(problem);
  start.hypothesis.candidates = out.set;
  start.hypothesis.values.emplace_back();
  for (const auto& parameter : found->parameters)
    start.hypothesis.values.back().push_back(sign * parameter.typical);
  out.fit = fit_from(problem, start);
  return out;
}

// A campaign in which each trial was recorded twice has the evidence of one with every trial counted twice.
TEST(DiagnoseBagged, AWeightOfTwoIsATrialRecordedTwice) {
  const auto once = drops(dragged, 1, 4);
  auto twice = once;
  for (std::size_t i = 0; i < once.trials.size(); ++i) {
    twice.trials.push_back(once.trials[i]);
    twice.trials.back().name += " again";
    twice.beliefs.push_back(once.beliefs[i]);
  }
  Problem problem = prepared(once);
  Search search(problem, {.most_effects = 1});
  const Fit fit = search.run(null_point(problem)).fit;
  const AtFit at = linearised_at(problem, fit.point);
  const auto weighted = weighted_log_evidence(problem, fit, at, Eigen::MatrixXd::Constant(4, 1, 2.0)).front();
  EXPECT_NEAR(weighted_log_evidence(problem, fit, at, Eigen::MatrixXd::Ones(4, 1)).front(),
              log_evidence(problem, fit, at).value, 1e-9);

  Problem doubled = prepare(twice).problem;
  doubled.noise = problem.noise;
  Point point = fit.point;
  point.nuisances.insert(point.nuisances.end(), fit.point.nuisances.begin(), fit.point.nuisances.end());
  const Fit again = fit_from(doubled, point, {.max_iterations = 0});
  EXPECT_NEAR(log_evidence(doubled, again, linearised_at(doubled, again.point)).value, weighted,
              1e-3 * std::abs(weighted));
}

// All trials show the same law.
TEST(DiagnoseBagged, ATrueSetIsAsSureAsItsEvidence) {
  const Problem problem = prepared(drops(dragged));
  Search search(problem, {.most_effects = 1});
  const SetFit& best = search.run(null_point(problem));
  const auto masses = bagged_masses(problem, {&search.null(), &best});
  EXPECT_GT(masses[1], 0.99);
  EXPECT_NEAR(masses[0] + masses[1], 1.0, 1e-9);
}

// Half of the trials are those of one law, half those of another one: the evidence is sure of one of them,
// and other trials would be sure of the other.
TEST(DiagnoseBagged, TrialsThatDisagreeLeaveBothNamesInQuestion) {
  auto recordings = drops(dragged, 1, 8);
  const auto others = drops([](double, double, double v) { return -0.012 * v; }, 2, 8);
  for (std::size_t i = 0; i < 4; ++i) recordings.trials[2 * i] = others.trials[2 * i];
  const Problem problem = prepared(recordings);
  const SetFit quadratic = fitted(problem, "air.quadratic_drag"), linear = fitted(problem, "air.linear_drag");
  const std::vector<const SetFit*> fits{&quadratic, &linear};
  std::vector<double> evidence;
  for (const SetFit* fit : fits)
    evidence.push_back(log_evidence(problem, fit->fit, linearised_at(problem, fit->fit.point)).value);
  EXPECT_GT(std::abs(evidence[0] - evidence[1]), std::log(20.0)) << "the evidence is sure";
  EXPECT_GT(std::ranges::min(bagged_masses(problem, fits)), 0.05) << "the trials are not";
}

// A free pendulum swings as fast with a smaller inertia as with a heavier weight: in proportion, the one
// change is 30 % and the other 43 %. That a law's form may be wrong by a share of its size says nothing
// about which of the two it is.
TEST(DiagnoseBagged, TheSizeOfAChangeDoesNotTellInertiaFromGravity) {
  const Problem problem = prepared(free_swings({.gravity_torque_Nm = 2.0 / 0.7}));
  const auto evidence = [&](const std::string& name, double sign) {
    const Fit fit = fitted(problem, name, sign).fit;
    return log_evidence(problem, fit, linearised_at(problem, fit.point)).value;
  };
  EXPECT_NEAR(evidence("axis.inertia", -1.0), evidence("axis.gravity", 1.0), std::log(kLimits.exchangeable));
}

}  // namespace
}  // namespace sandhopper::diagnose
