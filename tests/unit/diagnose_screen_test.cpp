#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tools/diagnose/evidence/screen.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// The block's pooled regression is taken from every column, trial by trial: T' gram T, T = I - E regression.
TEST(DiagnoseScreen, EliminatesABlockOfColumnsFromEveryTrial) {
  std::vector<TrialLinear> trials(3);
  MatrixXd pooled = MatrixXd::Zero(7, 7);
  for (auto& trial : trials) {
    const MatrixXd x = MatrixXd::Random(20, 7);
    trial.gram = x.transpose() * x;
    pooled += trial.gram;
  }
  const VectorXd prior = VectorXd::Constant(2, 0.5);
  MatrixXd block = pooled.block(1, 1, 2, 2);
  block.diagonal() += prior;
  MatrixXd transform = MatrixXd::Identity(7, 7);
  const MatrixXd regression = block.inverse() * pooled.middleRows(1, 2);
  for (Index j = 0; j < 7; ++j)
    if (j != 1 && j != 2) transform.block(1, j, 2, 1) = -regression.col(j);
  const auto grams = eliminated(trials, 1, 2, prior);
  for (std::size_t t = 0; t < trials.size(); ++t)
    EXPECT_LT((grams[t] - transform.transpose() * trials[t].gram * transform).cwiseAbs().maxCoeff(), 1e-10);
}

}  // namespace
}  // namespace sandhopper::diagnose
