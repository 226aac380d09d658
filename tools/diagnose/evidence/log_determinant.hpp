#pragma once
#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace sandhopper::diagnose {

// Of a symmetric positive definite matrix.
inline double log_determinant(const Eigen::MatrixXd& m) {
  return 2.0 * m.llt().matrixLLT().diagonal().array().abs().log().sum();
}

}  // namespace sandhopper::diagnose
