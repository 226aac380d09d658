#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/diagnose/evidence/screen.hpp"
#include "tools/diagnose/fit/fit.hpp"
#include "tools/diagnose/fit/linearise.hpp"
#include "tools/diagnose/fit/prepare.hpp"
#include "tools/diagnose/fit/signatures.hpp"

// Compares the linear algebra of the diagnosis with dense matrices written as in the equations.
namespace sandhopper::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

class EmptyTrial final : public TrialModel {
 public:
  void predict(const Edits&, std::span<const double>, std::span<double>) const override {}
};

// A first-order autoregression of unit variance has the covariance a^|i - j|. It is 0 across an unused row,
// across the end of a block, and between channels.
TEST(DiagnoseOracle, WhiteningIsThatOfTheDenseCovarianceOfAnAutoregression) {
  constexpr Index kRows = 24;
  constexpr double kA = 0.7;
  EmptyTrial trial;
  std::vector<std::uint8_t> used(kRows, 1);
  used[9] = 0;
  std::vector<double> sd(kRows);
  for (Index k = 0; k < kRows; ++k) {
    Row row;
    row.channel = k < 16 ? 0u : 1u;
    row.block = k < 5 ? 0u : 1u;
    row.relative_sd = 1.0 + 0.1 * static_cast<double>(k % 3);
    trial.rows.push_back(row);
    sd[static_cast<std::size_t>(k)] = row.relative_sd * (row.channel == 0 ? 2.0 : 0.5);
  }
  const Autoregression first{{kA}, std::sqrt(1.0 - kA * kA)};
  const NoiseModel noise({{{2.0}, {first}, {100.0}}, {{0.5}, {first}, {100.0}}});
  const auto chain = [&](Index k) { return k < 5 ? 0 : k < 9 ? 1 : k == 9 ? 2 : k < 16 ? 3 : 4; };
  MatrixXd covariance = MatrixXd::Zero(kRows, kRows);
  for (Index i = 0; i < kRows; ++i)
    for (Index j = 0; j < kRows; ++j)
      if (chain(i) == chain(j))
        covariance(i, j) = sd[static_cast<std::size_t>(i)] * sd[static_cast<std::size_t>(j)] *
                           std::pow(kA, std::abs(static_cast<double>(i - j)));
  MatrixXd whitening = MatrixXd::Identity(kRows, kRows);
  noise.whiten(trial, used, whitening);
  MatrixXd expected = MatrixXd::Identity(kRows, kRows);
  expected(9, 9) = 0.0;
  EXPECT_LT((whitening * covariance * whitening.transpose() - expected).cwiseAbs().maxCoeff(), 1e-12);
}

// X'X - X'Z (Z'Z + S^-1)^-1 Z'X, with X and Z from differences of the prediction, as dense matrices.
TEST(DiagnoseOracle, NuisancesAreEliminatedAsTheDenseFormulaDoes) {
  const auto prepared = prepare(swings([](double, double, double) { return 0.0; }, 1, 2));
  const Problem& problem = prepared.problem;
  const Point point = null_point(problem);
  const auto directions = parameter_directions(problem, point);
  ASSERT_GT(directions.size(), 0u);
  for (std::size_t t = 0; t < problem.trials.size(); ++t) {
    const TrialModel& trial = *problem.trials[t];
    const auto at = [&](const Edits& edits, const std::vector<double>& nuisances) {
      return predicted(problem, trial, edits, nuisances);
    };
    const VectorXd centre = at({}, point.nuisances[t]);
    MatrixXd x(centre.size(), 1 + static_cast<Index>(directions.size()));
    x.col(0) = residual_of(trial, centre);
    for (std::size_t i = 0; i < directions.size(); ++i) {
      constexpr double kStep = 0.1;  // relative to the tolerance's scale
      ASSERT_GE(directions[i].tolerance, 0);
      Edits moved;
      problem.tolerances[static_cast<std::size_t>(directions[i].tolerance)].put(moved, kStep);
      x.col(1 + static_cast<Index>(i)) = (at(moved, point.nuisances[t]) - centre) / kStep;
    }
    const auto count = static_cast<Index>(trial.nuisance_count());
    ASSERT_GT(count, 0);
    MatrixXd z(centre.size(), count);
    VectorXd information(count);
    const auto shared = static_cast<Index>(trial.trial_nuisances.size());
    for (Index n = 0; n < count; ++n) {
      const auto k = static_cast<std::size_t>(n);
      const double sd = trial.sd_of(k);
      const auto& nuisance =
          n < shared
              ? trial.trial_nuisances[k]
              : trial.block_nuisances[static_cast<std::size_t>(n - shared) % trial.block_nuisances.size()];
      // The same step as in the program: at most half a standard deviation, one-sided for a block's nuisance.
      const double step = std::min(nuisance.step, 0.5 * sd), back = n < shared ? step : 0.0;
      auto more = point.nuisances[t], less = more;
      more[k] += step;
      less[k] -= back;
      z.col(n) = (at({}, more) - at({}, less)) / (step + back);
      information[n] = 1.0 / (sd * sd);
    }
    whiten(problem, t, x);
    whiten(problem, t, z);
    const MatrixXd held = z.transpose() * z + MatrixXd(information.asDiagonal());
    const MatrixXd dense = x.transpose() * x - x.transpose() * z * held.ldlt().solve(z.transpose() * x);
    const TrialLinear linear = linearise(problem, t, {}, point.nuisances[t], directions);
    const MatrixXd& gram = linear.gram;
    const double determinant =
        held.ldlt().vectorD().array().log().sum() - information.array().log().sum();  // ln |I + S Z'Z|
    EXPECT_GT(determinant, 1.0);
    EXPECT_NEAR(linear.log_determinant, determinant, 1e-6 * determinant);
    ASSERT_EQ(gram.rows(), dense.rows());
    for (Index i = 0; i < dense.rows(); ++i)
      for (Index j = 0; j < dense.cols(); ++j)
        EXPECT_NEAR(gram(i, j), dense(i, j), 1e-6 * std::sqrt(dense(i, i) * dense(j, j))) << i << ' ' << j;
  }
}

// Columns that are eliminated over all trials together must give the Schur complement of the stacked system.
TEST(DiagnoseOracle, EliminatedColumnsLeaveTheSchurComplementOfAllTrials) {
  Random random(3, 0);
  std::vector<TrialLinear> trials(4);
  constexpr Index kKept = 3, kGone = 2;
  MatrixXd pooled = MatrixXd::Zero(kKept + kGone, kKept + kGone);
  for (auto& trial : trials) {
    MatrixXd columns(30, kKept + kGone);
    for (double& value : columns.reshaped()) value = random.normal();
    trial.gram = columns.transpose() * columns;
    pooled += trial.gram;
  }
  const VectorXd prior = Eigen::Vector2d(5.0, 0.1);
  MatrixXd gone = pooled.bottomRightCorner(kGone, kGone);
  gone.diagonal() += prior;
  // The prior's term belongs to no single trial: with T the regression, the Schur complement is sum T'AT +
  // T'PT.
  const MatrixXd regression = gone.ldlt().solve(pooled.bottomLeftCorner(kGone, kKept));
  const MatrixXd schur =
      pooled.topLeftCorner(kKept, kKept) - pooled.topRightCorner(kKept, kGone) * regression;
  MatrixXd sum = regression.transpose() * prior.asDiagonal() * regression;
  for (const auto& gram : eliminated(trials, kKept, kGone, prior)) sum += gram.topLeftCorner(kKept, kKept);
  EXPECT_LT((sum - schur).cwiseAbs().maxCoeff(), 1e-9 * schur.cwiseAbs().maxCoeff());
}

}  // namespace
}  // namespace sandhopper::diagnose
