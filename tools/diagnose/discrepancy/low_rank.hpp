#pragma once
#include <Eigen/Core>

namespace sandhopper::diagnose {

// Model error of one trial along known columns D, in addition to white noise:
//   r = D a + eps,   a ~ N(0, I),   eps ~ N(0, I),   so that   cov r = I + D D'
// It is whitened with (I + D D')^-1/2 = I - Q diag(s) Q'. Q: left singular vectors of D, d: its singular
// values, s = 1 - 1 / sqrt(1 + d^2).
class LowRank {
 public:
  LowRank() = default;
  // `columns`: D, rows x count, whitened by the noise model like the residuals.
  explicit LowRank(const Eigen::MatrixXd& columns);

  // Whitens each column of `values` in place.
  void whiten(Eigen::Ref<Eigen::MatrixXd> values) const;

  // Posterior mean of a for a residual before this whitening: (I + D'D)^-1 D' r. `columns`: D.
  Eigen::VectorXd amplitudes(const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual) const;

  // Effective number of degrees of freedom that the columns take from the residual: sum of d^2 / (1 + d^2).
  double taken_up() const;
  // ln |I + D D'|
  double log_determinant() const;
  bool empty() const { return shrink_.size() == 0; }

 private:
  Eigen::MatrixXd directions_;  // Q
  Eigen::VectorXd squares_;     // d^2
  Eigen::VectorXd shrink_;      // s
};

}  // namespace sandhopper::diagnose
