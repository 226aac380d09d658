#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numeric>

#include "tools/diagnose/discrepancy/free_laws.hpp"
#include "tools/diagnose/evidence/form_error.hpp"
#include "tools/diagnose/evidence/limits.hpp"
#include "tools/plant/random.hpp"

// Form errors of laws, against dense algebra.
namespace sandhopper::diagnose {
namespace {

using Eigen::Index, Eigen::MatrixXd;

MatrixXd random_matrix(Index rows, Index columns) {
  Random random(3, 1);
  return MatrixXd::NullaryExpr(rows, columns, [&] { return random.normal(); });
}

std::vector<Index> columns(Index from, Index count) {
  std::vector<Index> out(static_cast<std::size_t>(count));
  std::iota(out.begin(), out.end(), from);
  return out;
}

// X' V^-1 X with V = I + F C F', and ln|V|.
TEST(DiagnoseFormError, FormsAreIntegratedOut) {
  constexpr Index kRows = 40, kKept = 3, kEffects = 2;
  const MatrixXd x = random_matrix(kRows, kKept + kEffects * kFormKnots);
  const MatrixXd kept = x.leftCols(kKept), forms = x.rightCols(kEffects * kFormKnots);
  const MatrixXd information = form_information(kEffects);
  const MatrixXd v = MatrixXd::Identity(kRows, kRows) + forms * information.inverse() * forms.transpose();
  const auto without =
      without_forms(x.transpose() * x, columns(0, kKept), columns(kKept, kEffects * kFormKnots), information);
  EXPECT_LT((without.gram - kept.transpose() * v.inverse() * kept).norm(), 1e-9 * without.gram.norm());
  EXPECT_NEAR(without.log_determinant, std::log(v.determinant()), 1e-6);
}

TEST(DiagnoseFormError, WithoutFormsTheGramStays) {
  const MatrixXd x = random_matrix(10, 4);
  const MatrixXd gram = x.transpose() * x;
  EXPECT_EQ(without_forms(gram, columns(0, 4), {}, {}).gram, gram);
}

// One effect: correlated along the knots, and with the scatter of its size. Two effects: independent.
TEST(DiagnoseFormError, TheirPriorIsThatOfTheLimits) {
  const MatrixXd one = form_information(1).inverse(), two = form_information(2).inverse();
  const MatrixXd expected = (kLimits.form * kLimits.form * knot_correlation(kFormKnots)).array() +
                            kLimits.size_of_trial * kLimits.size_of_trial;
  EXPECT_LT((one - expected).norm(), 1e-9);
  EXPECT_LT((two.topLeftCorner(kFormKnots, kFormKnots) - expected).norm(), 1e-9);
  EXPECT_LT(two.topRightCorner(kFormKnots, kFormKnots).norm(), 1e-12);
}

// Squares of standard deviations that two errors of 10 % count for: a size that is off in one trial, and a
// form that is off by +-10 % in turns. Half or double the limits are outside.
TEST(DiagnoseFormError, AnErrorOfTenPerCentCountsForFewStandardDeviations) {
  const MatrixXd information = form_information(1);
  const Eigen::VectorXd size = Eigen::VectorXd::Constant(kFormKnots, 0.1);
  const Eigen::VectorXd form = Eigen::VectorXd::NullaryExpr(kFormKnots, [](Index i) {
    return 0.1 * std::sqrt(2.0) * std::cos(2.0 * M_PI * static_cast<double>(i) / (kFormKnots - 1.0));
  });
  EXPECT_NEAR(size.dot(information * size), 1.6, 0.5);
  EXPECT_NEAR(form.dot(information * form), 8.5, 3.0);
}

}  // namespace
}  // namespace sandhopper::diagnose
