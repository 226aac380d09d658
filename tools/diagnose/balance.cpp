#include "tools/diagnose/balance.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace sandhopper::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

}  // namespace

std::vector<double> rest_without_known(const Balance& balance) {
  const auto n = static_cast<Index>(balance.rest.size());
  const auto known = static_cast<Index>(balance.known.size());
  MatrixXd x(n, 1 + known);
  x.col(0).setOnes();
  for (Index i = 0; i < known; ++i)
    x.col(1 + i) = Eigen::Map<const VectorXd>(balance.known[static_cast<std::size_t>(i)].data(), n);
  const VectorXd scale = x.colwise().norm().cwiseMax(1e-300).cwiseInverse();
  x = x * scale.asDiagonal();
  const Eigen::Map<const VectorXd> rest(balance.rest.data(), n);
  const MatrixXd normal = x.transpose() * x + 1e-9 * MatrixXd::Identity(1 + known, 1 + known);
  const VectorXd left = rest - x * normal.ldlt().solve(x.transpose() * rest);
  return {left.data(), left.data() + left.size()};
}

}  // namespace sandhopper::diagnose
