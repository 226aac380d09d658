#include "tools/diagnose/discrepancy/low_rank.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace sandhopper::diagnose {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

LowRank::LowRank(const MatrixXd& columns) {
  if (columns.cols() == 0) return;
  // D has many more rows than columns: use D'D = V diag(d^2) V' and Q = D V / d.
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(columns.transpose() * columns);
  const VectorXd& squares = solver.eigenvalues();  // ascending
  const double least = 1e-6;                       // Drop directions below 1/1000 of the noise.
  Index first = 0;
  while (first < squares.size() && squares[first] < least) ++first;
  const Index kept = squares.size() - first;
  squares_ = squares.tail(kept);
  directions_ = columns * solver.eigenvectors().rightCols(kept);
  for (Index i = 0; i < kept; ++i) directions_.col(i) /= std::sqrt(squares_[i]);
  shrink_ = 1.0 - (1.0 + squares_.array()).rsqrt();
}

void LowRank::whiten(Eigen::Ref<MatrixXd> values) const {
  if (empty()) return;
  const MatrixXd along = directions_.transpose() * values;
  values.noalias() -= directions_ * (shrink_.asDiagonal() * along);
}

VectorXd LowRank::amplitudes(const MatrixXd& columns, const VectorXd& residual) const {
  MatrixXd information = columns.transpose() * columns;
  information.diagonal().array() += 1.0;
  return information.ldlt().solve(columns.transpose() * residual);
}

double LowRank::taken_up() const { return (squares_.array() / (1.0 + squares_.array())).sum(); }

double LowRank::log_determinant() const { return (1.0 + squares_.array()).log().sum(); }

}  // namespace sandhopper::diagnose
