#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "tests/unit/diagnose_hops.hpp"
#include "tools/diagnose/fit/fit.hpp"
#include "tools/diagnose/fit/prepare.hpp"
#include "tools/diagnose/fit/signatures.hpp"
#include "tools/diagnose/model/signal.hpp"

// Convergence of fits, and the derivatives that they use.
namespace sandhopper::diagnose {
namespace {

constexpr std::size_t kRows = 40;

// A model with one nuisance z: row k predicts curve(z) (1 + k / 40).
class Curve final : public TrialModel {
 public:
  Curve(double (*curve)(double), double measured_at, double sd, double step) : curve_(curve) {
    trial_nuisances = {{"z", sd, step}};
    for (std::size_t k = 0; k < kRows; ++k)
      rows.push_back({.time_s = 1e-3 * static_cast<double>(k), .measured = weight(k) * curve(measured_at)});
  }
  void predict(const Edits&, std::span<const double> z, std::span<double> out) const override {
    for (std::size_t k = 0; k < kRows; ++k) out[k] = weight(k) * curve_(z[0]);
  }

 private:
  static double weight(std::size_t k) { return 1.0 + static_cast<double>(k) / kRows; }
  double (*curve_)(double);
};

Problem with(std::unique_ptr<TrialModel> trial) {
  Problem problem;
  problem.channels = {"height_m"};
  problem.phases = {"all"};
  problem.used = {std::vector<std::uint8_t>(trial->rows.size(), 1)};
  problem.trials.push_back(std::move(trial));
  problem.noise = white_noise(std::vector<double>{0.01}, 1);
  return problem;
}

// sin(40 z) / 40 has the slope 1 at zero. Over +-0.08, which is 2.5 times the plausible range of z, the
// secant's slope is -0.02.
TEST(DiagnoseFit, ADerivativeIsTakenOverNoMoreThanTheNuisanceMayMoveBy) {
  const Problem problem =
      with(std::make_unique<Curve>([](double z) { return std::sin(40.0 * z) / 40.0; }, 0.0, 0.032, 0.08));
  const auto columns = columns_at(problem, null_point(problem));
  EXPECT_GT(columns.front().shared(0, 0), 0.9);
}

// A slope with a ripple: where it is flattest, a full Newton step goes three times too far.
TEST(DiagnoseFit, ATrialThatAFullStepOvershootsGoesOnInShorterOnes) {
  const auto ripple = [](double z) { return z + 0.2 * std::sin(4.0 * z); };
  Problem problem = with(std::make_unique<Curve>(ripple, 0.9, 10.0, 0.01));
  Point start = null_point(problem);
  start.nuisances[0][0] = -0.9;
  keep_columns(problem, start);
  const Fit fit = fit_from(problem, start, {.columns_made_here = true});
  EXPECT_EQ(fit.status, FitStatus::converged);
  EXPECT_NEAR(fit.point.nuisances[0][0], 0.9, 0.01);
  EXPECT_LT(fit.deviance, 1.0);
}

Recordings hops(std::size_t count) {
  Recordings r;
  r.plant = PlantKind::hopper;
  for (std::size_t i = 0; i < count; ++i) {
    const HopperRun run = hop_from(0.04 + 0.003 * static_cast<double>(i), 0.45);
    r.trials.push_back(recorded(run, {}, i + 1));
    r.beliefs.push_back(r.belief);
  }
  return r;
}

// At the end of a fit, derivatives computed there must not promise a further gain.
TEST(DiagnoseFit, AFitThatEndedGainsNothingFromDerivativesMadeThere) {
  Problem problem = prepare(hops(3)).problem;
  Point point = fit_from(problem, null_point(problem), {.max_iterations = 6}).point;
  update_noise(problem, point);
  keep_columns(problem, point);
  const Fit ended = fit_from(problem, point, {.columns_made_here = true});
  keep_columns(problem, ended.point);
  const Fit again = fit_from(problem, ended.point, {.columns_made_here = true});
  EXPECT_LT(ended.deviance - again.deviance, 1.0);
}

TEST(DiagnoseFit, SignaturesAreTheSimulationWithALittleOfEachEffect) {
  const Problem problem = prepare(hops(1)).problem;
  const Point point = null_point(problem);
  const auto signatures = signatures_at(problem, point);
  ASSERT_FALSE(signatures.alternatives.empty());
  ASSERT_FALSE(signatures.laws.empty());
  const TrialModel& trial = *problem.trials[0];
  const auto centre = predicted(problem, trial, edits_for(problem, {}, point.tolerances), point.nuisances[0]);
  for (const auto& alternative : signatures.alternatives)
    for (std::size_t i = 0; i < alternative.amplitudes.size(); ++i) {
      Hypothesis hypothesis{{alternative.candidate}, {alternative.values}, {}, {}};
      const auto& parameter = problem.candidates[alternative.candidate].parameters[alternative.amplitudes[i]];
      double& value = hypothesis.values[0][alternative.amplitudes[i]];
      const double step = alternative.steps[i];
      const bool central = parameter.central_step > 0.0 && value == 0.0;
      const auto moved_by = [&](double by) {
        value = by * parameter.typical;
        return predicted(problem, trial, edits_for(problem, hypothesis, point.tolerances),
                         point.nuisances[0]);
      };
      const Eigen::VectorXd moved = moved_by(step);
      const Eigen::VectorXd expected =
          central ? Eigen::VectorXd((moved - moved_by(-step)) / (2.0 * step)) : (moved - centre) / step;
      EXPECT_LT(
          (signatures.columns[0].col(alternative.first + static_cast<Eigen::Index>(i)) - expected).norm(),
          1e-9 * (1.0 + expected.norm()))
          << problem.candidates[alternative.candidate].label();
    }
}

// The mean of sin(w t) over a window T is sin(w t) sin(w T / 2) / (w T / 2).
TEST(DiagnoseSignal, AShareOfWhatIsRecordedIsTheMeanOverAWindow) {
  constexpr double kOmega = 900.0, kWindow_s = 2e-3;
  Signal signal{0.0, 1e-4, {}};
  for (int i = 0; i < 1000; ++i) signal.values.push_back(std::sin(kOmega * 1e-4 * i));
  const double mean = std::sin(0.5 * kOmega * kWindow_s) / (0.5 * kOmega * kWindow_s);
  for (const double share : {0.0, 0.5, 1.0}) {
    Edits edits;
    edits.sensor("force_N", SensorEdit::Kind::mean_share, share, kWindow_s);
    const std::vector<double> at_s{0.02, 0.0315, 0.05};
    std::vector<double> out(at_s.size());
    Signal used = signal;
    observe(used, {}, edits, "force_N", at_s, out);
    for (std::size_t i = 0; i < at_s.size(); ++i)
      EXPECT_NEAR(out[i], (1.0 + share * (mean - 1.0)) * std::sin(kOmega * at_s[i]), 2e-3);
  }
}

}  // namespace
}  // namespace sandhopper::diagnose
