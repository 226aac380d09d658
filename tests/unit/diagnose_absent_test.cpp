#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/diagnose/answer/report_parts.hpp"
#include "tools/diagnose/fit/fit.hpp"
#include "tools/diagnose/fit/linearise.hpp"
#include "tools/diagnose/fit/prepare.hpp"
#include "tools/diagnose/fit/signatures.hpp"
#include "tools/diagnose/fit/statistics.hpp"

// Upper bounds of effects that were not found.
namespace sandhopper::diagnose {
namespace {

constexpr double kDrag_kg_per_m = 0.003;

double drag_N(double, double, double v) { return -kDrag_kg_per_m * std::abs(v) * v; }

// Drops whose belief knows the drag: 1/2 rho c A = 0.003 kg/m with the density 1.2 kg/m^3 and the area 0.01
// m^2.
Recordings drops_with_known_drag() {
  auto recordings = drops(drag_N);
  recordings.belief.numbers["medium.drag_coefficient"] = kDrag_kg_per_m / (0.5 * 1.2 * 0.01);
  for (auto& belief : recordings.beliefs) belief = recordings.belief;
  return recordings;
}

// A delay of 4 ms is within the tolerance of the accelerometer's times, rows come every 5 ms. So nothing is
// found, but a lag of 4 ms may be there in place of the tolerance, beside what the noise allows on top.
TEST(DiagnoseAbsent, ALagInPlaceOfATolerancesDelayIsWithinItsBound) {
  constexpr double kDelay_s = 0.004, kRow_s = 0.005, kLeastNoise_s = 0.002;
  auto recordings = drops_with_known_drag();
  for (auto& trial : recordings.trials) {
    auto& a = trial.channels.at("accel_mps2");
    for (std::size_t i = a.size() - 1; i > 0; --i) a[i] += (a[i - 1] - a[i]) * kDelay_s / kRow_s;
  }
  const auto d = diagnose(recordings);
  ASSERT_EQ(d.verdict, Verdict::consistent);
  const auto lag = std::ranges::find(d.absent, "imu.lag[accel_mps2]", &Bound::id);
  ASSERT_NE(lag, d.absent.end());
  EXPECT_GT(lag->value, kDelay_s + kLeastNoise_s);
}

// Nothing tells a late clock of heights from another release height and speed, but for the curvature. A bound
// that the size's own prior gives as well (97.5 %: e^1.96 typical sizes) is not printed.
TEST(DiagnoseAbsent, ABoundThatTheRecordingsDoNotGiveIsNotPrinted) {
  const auto d = diagnose(drops([](double, double, double) { return 0.0; }));
  ASSERT_EQ(d.verdict, Verdict::consistent);
  ASSERT_FALSE(d.absent.empty());
  EXPECT_LT(d.absent.front().typicals, std::exp(1.96));
  EXPECT_TRUE(
      std::ranges::none_of(d.absent, [](const Bound& bound) { return bound.id == "clock.skew[height_m]"; }));
}

// The column of a candidate with a given size is the secant up to that size.
TEST(DiagnoseAbsent, ASignatureOfAGivenSizeIsTheSecant) {
  constexpr double kSize = 3.0;
  const auto recordings = drops_with_known_drag();
  const Prepared prepared = prepare(recordings);
  const Problem& problem = prepared.problem;
  const auto lag = std::ranges::find(problem.candidates, "imu.lag[accel_mps2]", &Candidate::label);
  ASSERT_NE(lag, problem.candidates.end());
  const auto index = static_cast<std::size_t>(lag - problem.candidates.begin());
  const Point point = null_point(problem);
  const std::map<std::size_t, double> sizes{{index, kSize}};
  const auto signatures = signatures_at(problem, point, {.laws = false, .sizes = &sizes});
  ASSERT_FALSE(signatures.alternatives.empty());
  for (const auto& alternative : signatures.alternatives) EXPECT_EQ(alternative.candidate, index);

  Hypothesis with;
  with.candidates = {index};
  with.values = {signatures.alternatives.front().values};
  with.values[0][0] = kSize * lag->parameters[0].typical;
  const TrialModel& trial = *problem.trials[0];
  const auto at = [&](const Hypothesis& hypothesis) {
    return predicted(problem, trial, edits_for(problem, hypothesis, point.tolerances), point.nuisances[0]);
  };
  const Eigen::VectorXd secant = (at(with) - at({})) / kSize;
  ASSERT_GT(secant.norm(), 0.0);
  EXPECT_LT((signatures.columns[0].col(0) - secant).norm(), 1e-12 * secant.norm());
}

// The bounds of one answer hold together: each leaves out its share of 5 %.
TEST(DiagnoseAbsent, EveryBoundLeavesOutItsShareOfTheRisk) {
  Problem problem = prepare(drops_with_known_drag()).problem;
  const Point point = fit_from(problem, null_point(problem)).point;
  keep_columns(problem, point);
  Search search(problem, {});
  search.run(point);
  ASSERT_TRUE(search.best().set.empty());
  Diagnosis d;
  report_absent(problem, search, d);
  std::size_t compared = 0;
  for (const auto& s : search.screened({})) {
    const auto bound = std::ranges::find(d.absent, problem.candidates[s.candidate].label(), &Bound::id);
    if (bound == d.absent.end()) continue;
    const double t = student_t_quantile(0.05 / static_cast<double>(problem.candidates.size()),
                                        s.evidence.scatter().degrees_of_freedom);
    EXPECT_GE(bound->typicals * (1.0 + 1e-9), std::abs(s.evidence.size()) + t * s.evidence.standard_error())
        << bound->id;
    ++compared;
  }
  EXPECT_GT(compared, 5u);
}

// Drops of a height sensor that hardly sees anything bound no effect by less than its range: no such bound is
// printed.
TEST(DiagnoseAbsent, ABoundBeyondTheRangeOfAnEffectIsNoBound) {
  auto recordings = drops([](double, double, double) { return 0.0; }, 1, 6);
  recordings.belief.numbers["sensors.height_noise_m"] = 0.3;
  recordings.beliefs.assign(recordings.trials.size(), recordings.belief);
  for (std::size_t i = 0; i < recordings.trials.size(); ++i) {
    Random random(4, i);
    auto& channels = recordings.trials[i].channels;
    channels.erase("accel_mps2");
    for (double& height : channels["height_m"]) height += 0.3 * random.normal();
  }
  Problem problem = prepare(recordings).problem;
  const Point point = fit_from(problem, null_point(problem)).point;
  keep_columns(problem, point);
  Search search(problem, {});
  search.run(point);
  Diagnosis d;
  report_absent(problem, search, d);
  for (const auto& candidate : problem.candidates) {
    const auto bound = std::ranges::find(d.absent, candidate.label(), &Bound::id);
    if (bound == d.absent.end()) continue;
    const auto& p = candidate.parameters.front();
    EXPECT_LE(bound->typicals * p.typical, std::max(std::abs(p.low), std::abs(p.high))) << bound->id;
  }
  EXPECT_LT(d.absent.size(), problem.candidates.size() - search.best().set.size());
}

// A stiffness or a limit falls as its effect grows, a number of the belief is bounded by its change.
TEST(DiagnoseAbsent, BoundsSayWhatTheyBound) {
  const auto d = diagnose(drops_with_known_drag());
  ASSERT_EQ(d.verdict, Verdict::consistent);
  const auto drag = std::ranges::find(d.absent, "air.quadratic_drag", &Bound::id);
  ASSERT_NE(drag, d.absent.end());
  EXPECT_EQ(drag->parameter, "drag_coefficient_change");
  EXPECT_FALSE(drag->is_lower);
  for (const auto& bound : d.absent) {
    EXPECT_EQ(bound.is_lower, bound.id.starts_with("sensor.saturation")) << bound.id;
    EXPECT_GT(bound.value, 1e-12) << bound.id;
  }
}

}  // namespace
}  // namespace sandhopper::diagnose
