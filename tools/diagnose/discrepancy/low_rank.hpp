#pragma once
#include <Eigen/Core>

namespace sandhopper::diagnose {

// Model error of one trial along known columns, beside noise that is white already:
//   r = D a + eps,   a ~ N(0, I),   eps ~ N(0, I),   so that   cov r = I + D D'
// Whitening it means multiplying by (I + D D')^-1/2 = I - Q diag(s) Q', with the singular vectors Q and
// singular values d of D, s = 1 - 1 / sqrt(1 + d^2).
class LowRank {
 public:
  LowRank() = default;
  // `columns`: D, rows x count, whitened like the residuals.
  explicit LowRank(const Eigen::MatrixXd& columns);

  // Each column of `values`, in place.
  void whiten(Eigen::Ref<Eigen::MatrixXd> values) const;

  // Amplitudes a that a whitened residual (before this whitening) makes likeliest: (I + D'D)^-1 D' r.
  Eigen::VectorXd amplitudes(const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual) const;

  // How many of the residual's degrees of freedom the columns take up: sum of d^2 / (1 + d^2).
  double taken_up() const;
  // log |I + D D'|.
  double log_determinant() const;
  bool empty() const { return shrink_.size() == 0; }

 private:
  Eigen::MatrixXd directions_;  // Q
  Eigen::VectorXd squares_;     // d^2
  Eigen::VectorXd shrink_;      // s
};

}  // namespace sandhopper::diagnose
