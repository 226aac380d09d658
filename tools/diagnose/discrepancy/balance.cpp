#include "tools/diagnose/discrepancy/balance.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "tools/diagnose/discrepancy/misfit.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kKnots = 21;              // of a law
constexpr std::size_t kLeastRows = 50;  // rows of one trial
constexpr double kRidge = 1e-3;         // relative to the mean information of a knot
// Prior spread of the square roots of the held-out fractions (`p_of_gains`).
constexpr double kShareSpread = 0.1;

// Gram matrix of one trial: residual force, known shapes, terms of the law. The mean of each column is
// subtracted. The sum is divided by the sum of squares of the residual force.
MatrixXd products(const Balance& balance, const FreeFamily& family) {
  const auto n = static_cast<Index>(balance.rest.size());
  const auto known = static_cast<Index>(balance.known.size());
  MatrixXd x(n, 1 + known + static_cast<Index>(family.terms.size()));
  const auto column = [n](const std::vector<double>& v) { return Eigen::Map<const VectorXd>(v.data(), n); };
  x.col(0) = column(balance.rest);
  for (Index i = 0; i < known; ++i) x.col(1 + i) = column(balance.known[static_cast<std::size_t>(i)]);
  for (Index i = 1 + known; i < x.cols(); ++i)
    for (Index row = 0; row < n; ++row)
      x(row, i) = family.terms[static_cast<std::size_t>(i - 1 - known)].law(
          balance.states[static_cast<std::size_t>(row)]);
  x.rowwise() -= x.colwise().mean().eval();
  return x.transpose() * x / std::max(x.col(0).squaredNorm(), 1e-300);
}

// Gram matrices with the known shapes eliminated from all other columns. Their coefficients are fitted to all
// trials together.
std::vector<MatrixXd> without_known(const std::vector<MatrixXd>& trials, Index known) {
  MatrixXd sum = MatrixXd::Zero(trials.front().rows(), trials.front().cols());
  for (const auto& trial : trials) sum += trial;
  const Index width = sum.cols() - known;
  MatrixXd take_out = MatrixXd::Zero(sum.cols(), width);  // Maps the given columns to those of the result.
  take_out(0, 0) = 1.0;
  take_out.bottomRightCorner(width - 1, width - 1).setIdentity();
  if (known > 0) {
    MatrixXd others(known, width);
    others << sum.block(1, 0, known, 1), sum.block(1, 1 + known, known, width - 1);
    const VectorXd scale = sum.diagonal().segment(1, known).cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    MatrixXd scaled = scale.asDiagonal() * sum.block(1, 1, known, known) * scale.asDiagonal();
    scaled.diagonal().array() += kRidge;
    take_out.middleRows(1, known) -= scale.asDiagonal() * scaled.ldlt().solve(scale.asDiagonal() * others);
  }
  std::vector<MatrixXd> out;
  for (const auto& trial : trials) out.emplace_back(take_out.transpose() * trial * take_out);
  return out;
}

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

std::vector<FreeGain> laws_of_balances(const Problem& problem, const std::vector<Balance>& balances) {
  std::vector<FreeGain> gains;
  for (const auto& port : problem.plant->free_ports(problem.context)) {
    std::vector<const Balance*> series;
    std::vector<PortState> states;
    for (const auto& balance : balances)
      if (balance.port == port.port && balance.rest.size() >= kLeastRows) {
        series.push_back(&balance);
        states.insert(states.end(), balance.states.begin(), balance.states.end());
      }
    if (series.size() < kTooFewTrials) continue;
    for (const auto& family : free_families_over(port, states, kKnots)) {
      std::vector<MatrixXd> parts;
      for (const auto* balance : series) parts.push_back(products(*balance, family));
      parts = without_known(parts, static_cast<Index>(series.front()->known.size()));
      MatrixXd sum = MatrixXd::Zero(1 + kKnots, 1 + kKnots);
      for (const auto& part : parts) sum += part;
      const MatrixXd ridge =
          MatrixXd::Identity(kKnots, kKnots) * (kRidge * (sum.trace() - sum(0, 0)) / kKnots + 1e-12);
      const auto solved = [&](const MatrixXd& m) {
        return VectorXd((m.bottomRightCorner(kKnots, kKnots) + ridge).ldlt().solve(m.col(0).tail(kKnots)));
      };
      const double n = static_cast<double>(parts.size());
      std::vector<double> shares;
      for (const auto& part : parts) {
        const VectorXd size = solved(sum - part);
        shares.push_back((2.0 * size.dot(part.col(0).tail(kKnots)) -
                          size.dot(part.bottomRightCorner(kKnots, kKnots) * size)) /
                         std::max(part(0, 0), 1e-300));
      }
      FreeGain gain{family, 0.0, 0.0, p_of_gains(shares, kShareSpread), solved(sum), {}};
      for (const double share : shares) {
        gain.held_out += share / n;
        gain.trials_better += (share > 0.0 ? 1.0 : 0.0) / n;
      }
      const MatrixXd inverse =
          (sum.bottomRightCorner(kKnots, kKnots) + ridge).ldlt().solve(MatrixXd::Identity(kKnots, kKnots));
      // Rows of one trial are correlated, so trials are counted as independent samples, not rows.
      const double left = std::max(0.0, sum(0, 0) - sum.col(0).tail(kKnots).dot(gain.size));
      gain.sd = (inverse.diagonal() * left / n).cwiseMax(0.0).cwiseSqrt();
      if (std::isfinite(gain.held_out)) gains.push_back(std::move(gain));
    }
  }
  for (auto& gain : gains) gain.p_value = std::min(1.0, gain.p_value * static_cast<double>(gains.size()));
  std::ranges::sort(gains, [](const FreeGain& a, const FreeGain& b) { return a.held_out > b.held_out; });
  return gains;
}

}  // namespace sandhopper::diagnose
