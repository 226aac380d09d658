#pragma once
#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace sandhopper::diagnose {

// ln det(m) of a symmetric positive definite matrix, from its Cholesky factor.
inline double log_determinant(const Eigen::MatrixXd& m) {
  return 2.0 * m.llt().matrixLLT().diagonal().array().abs().log().sum();
}

}  // namespace sandhopper::diagnose
