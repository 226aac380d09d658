#include "tools/diagnose/rivals.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "tools/plant/random.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kDraws = 200;
constexpr std::size_t kMostRivals = 3;

// Columns of one linearisation at the first explanation: difference of the two, derivatives of the first, of
// the second.
struct Layout {
  std::vector<Direction> directions;
  Index first = 0, second = 0;  // count of derivatives
};

Layout layout_of(const Problem& problem, const Rivalry& rivalry) {
  const Point &a = rivalry.first->fit.point, &b = rivalry.second->fit.point;
  Layout layout;
  layout.directions.push_back({edits_for(problem, b.hypothesis, b.tolerances), 1.0});
  for (auto& d : parameter_directions(problem, a)) layout.directions.push_back(std::move(d));
  layout.first = static_cast<Index>(layout.directions.size()) - 1;
  for (auto& d : parameter_directions(problem, b)) layout.directions.push_back(std::move(d));
  layout.second = static_cast<Index>(layout.directions.size()) - 1 - layout.first;
  return layout;
}

// The derivatives of the second are differences to the first so far: column - difference / step makes them
// its own.
MatrixXd transform_of(const Layout& layout) {
  const Index n = 1 + static_cast<Index>(layout.directions.size());
  MatrixXd transform = MatrixXd::Identity(n, n);
  for (Index j = 2 + layout.first; j < n; ++j)
    transform(1, j) = -1.0 / layout.directions[static_cast<std::size_t>(j - 1)].step;
  return transform;
}

double chance_above(double lambda, double limit) {
  return lambda <= 0.0 ? 0.0 : 0.5 * std::erfc((limit - lambda) / (2.0 * std::sqrt(2.0 * lambda)));
}

}  // namespace

std::vector<Rivalry> rivalries(const Problem& problem, const Search& search, const Posterior& belief) {
  std::vector<Rivalry> out;
  const SetFit& best = search.best();
  for (const auto candidate : best.set) {
    const auto found = belief.alternatives.find(candidate);
    if (found == belief.alternatives.end()) continue;
    std::size_t taken = 0;
    for (const auto other : found->second) {
      auto set = best.set;
      std::replace(set.begin(), set.end(), candidate, other);
      std::sort(set.begin(), set.end());
      const auto it = search.sets().find(set);
      if (it == search.sets().end() || taken == kMostRivals) continue;
      ++taken;
      out.push_back(
          {&best, &it->second, problem.candidates[candidate].label(), problem.candidates[other].label()});
    }
  }
  return out;
}

Contest contest(const Problem& problem, const PlannedTrials& planned, std::size_t trial,
                const Rivalry& rivalry, double dispersion, double apart) {
  const Layout layout = layout_of(problem, rivalry);
  const Point& a = rivalry.first->fit.point;
  const auto linear =
      planned.linearised(trial, edits_for(problem, a.hypothesis, a.tolerances), layout.directions);
  const MatrixXd transform = transform_of(layout);
  const MatrixXd gram = transform.transpose() * linear.gram * transform;
  // What is left of some columns when an explanation follows them.
  const auto left = [&](Index from, Index count, const MatrixXd& information) {
    const MatrixXd own = information + gram.block(from, from, count, count);
    return MatrixXd(gram - gram.middleCols(from, count) * own.ldlt().solve(gram.middleRows(from, count)));
  };
  const MatrixXd by_second = left(2 + layout.first, layout.second, rivalry.second->fit.information);
  const MatrixXd by_first = left(2, layout.first, rivalry.first->fit.information);
  Contest out;
  out.lambda = std::max(0.0, std::min(by_second(1, 1), by_first(1, 1))) / dispersion;
  // The first's parameters as uncertain as they are: what other differences would then be seen?
  const Eigen::LLT<MatrixXd> information(rivalry.first->fit.information);
  Random random(1, trial);
  for (int draw = 0; draw < kDraws; ++draw) {
    VectorXd normal(layout.first);
    for (double& value : normal) value = random.normal();
    VectorXd v = VectorXd::Zero(gram.cols());
    v[1] = 1.0;
    if (layout.first > 0) v.segment(2, layout.first) = -information.matrixU().solve(normal);
    const double lambda = v.dot(by_second * v) / dispersion;
    out.settles += chance_above(std::min(lambda, out.lambda), apart) / kDraws;
  }
  return out;
}

Predictions predictions(const Problem& problem, const PlannedTrials& planned, std::size_t trial,
                        const Rivalry& rivalry) {
  const Layout layout = layout_of(problem, rivalry);
  const Point& a = rivalry.first->fit.point;
  const auto linear =
      planned.linearised(trial, edits_for(problem, a.hypothesis, a.tolerances), layout.directions, true);
  const MatrixXd transform = transform_of(layout);
  const MatrixXd gram = transform.transpose() * linear.gram * transform;
  const MatrixXd plain = linear.plain * transform;
  const Index from = 2 + layout.first, count = layout.second;
  VectorXd difference = plain.col(1);
  if (count > 0) {
    const MatrixXd own = rivalry.second->fit.information + gram.block(from, from, count, count);
    difference -= plain.middleCols(from, count) * own.ldlt().solve(gram.block(from, 1, count, 1)).col(0);
  }
  Predictions out;
  for (Index k = 0; k < difference.size(); ++k) {
    out.first.push_back(-linear.residual[k]);
    out.second.push_back(-linear.residual[k] + difference[k]);
  }
  return out;
}

}  // namespace sandhopper::diagnose
