#include "tools/diagnose/evidence/rivals.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "tools/plant/random.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kDraws = 200;             // of the parameters, for a probability: standard error at most 0.035
constexpr std::size_t kMostRivals = 5;  // explanations in one group, the best set included

Edits edits_of(const Problem& problem, const SetFit& fit) {
  return edits_for(problem, fit.fit.point.hypothesis, fit.fit.point.tolerances);
}

// Probability that a difference of deviances exceeds `limit`. The difference is normal with mean lambda and
// variance 4 lambda.
double chance_above(double lambda, double limit) {
  return lambda <= 0.0 ? 0.0 : 0.5 * std::erfc((limit - lambda) / (2.0 * std::sqrt(2.0 * lambda)));
}

}  // namespace

std::vector<Rivals> rivals_of(const Problem& problem, const Search& search, const Posterior& belief) {
  std::vector<Rivals> out;
  const SetFit& best = search.best();
  for (const auto candidate : best.set) {
    const auto found = belief.alternatives.find(candidate);
    if (found == belief.alternatives.end()) continue;
    Rivals rivals{{&best}, {problem.candidates[candidate].label()}, &search.null()};
    for (const auto other : found->second) {
      auto set = best.set;
      std::replace(set.begin(), set.end(), candidate, other);
      std::sort(set.begin(), set.end());
      const auto it = search.sets().find(set);
      if (it == search.sets().end() || rivals.size() == kMostRivals) continue;
      rivals.fits.push_back(&it->second);
      rivals.names.push_back(problem.candidates[other].label());
    }
    if (rivals.size() > 1) out.push_back(std::move(rivals));
  }
  return out;
}

Contest::Contest(const Problem& problem, const PlannedTrials& planned, std::size_t trial,
                 const Rivals& rivals, double dispersion)
    : fits_(rivals.fits), trial_(trial), dispersion_(dispersion) {
  fits_.push_back(rivals.null);
  for (std::size_t i = 0; i < fits_.size(); ++i) {
    Columns columns;
    if (i > 0) {
      directions_.push_back({edits_of(problem, *fits_[i]), 1.0});
      columns.difference = static_cast<Index>(directions_.size());
    }
    columns.from = static_cast<Index>(directions_.size()) + 1;
    for (auto& d : plain_directions(problem, fits_[i]->fit.point)) directions_.push_back(std::move(d));
    columns.count = static_cast<Index>(directions_.size()) + 1 - columns.from;
    columns_.push_back(columns);
  }
  const auto linear = planned.linearised(trial, edits_of(problem, *fits_[0]), directions_);
  // Every direction was simulated as a difference to the first explanation. For the derivatives of another
  // one, subtract that explanation's own difference, divided by the step; a central difference does not hold
  // it.
  transform_ = MatrixXd::Identity(linear.gram.rows(), linear.gram.cols());
  for (const auto& c : columns_)
    for (Index k = c.from; k < c.from + c.count && c.difference > 0; ++k) {
      const Direction& direction = directions_[static_cast<std::size_t>(k - 1)];
      if (direction.tolerance < 0 && !direction.opposite) transform_(c.difference, k) = -1.0 / direction.step;
    }
  gram_ = transform_.transpose() * linear.gram * transform_;
}

VectorXd Contest::between(std::size_t i, std::size_t j) const {
  VectorXd v = VectorXd::Zero(gram_.cols());
  if (columns_[j].difference > 0) v[columns_[j].difference] += 1.0;
  if (columns_[i].difference > 0) v[columns_[i].difference] -= 1.0;
  return v;
}

// Gram matrix after the parameters of j were refitted, with the information of the earlier trials as prior.
MatrixXd Contest::left(std::size_t j) const {
  const auto& c = columns_[j];
  if (c.count == 0) return gram_;
  const MatrixXd own = fits_[j]->fit.information + gram_.block(c.from, c.from, c.count, c.count);
  return gram_ - gram_.middleCols(c.from, c.count) * own.ldlt().solve(gram_.middleRows(c.from, c.count));
}

double Contest::rise(std::size_t i, std::size_t j) const {
  const VectorXd v = between(i, j);
  return std::max(0.0, v.dot(left(j) * v)) / dispersion_;
}

double Contest::lambda(std::size_t i, std::size_t j) const { return std::min(rise(i, j), rise(j, i)); }

double Contest::settles(std::size_t i, std::size_t j, double apart) const {
  const VectorXd v = between(i, j);
  const MatrixXd seen = left(j);
  const double most = lambda(i, j);
  const auto& c = columns_[i];
  const Eigen::LLT<MatrixXd> information(fits_[i]->fit.information);
  Random random(1, trial_);
  double sum = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    VectorXd u = v, normal(c.count);
    for (double& value : normal) value = random.normal();
    if (c.count > 0) u.segment(c.from, c.count) -= information.matrixU().solve(normal);
    sum += chance_above(std::min(most, u.dot(seen * u) / dispersion_), apart);
  }
  return sum / kDraws;
}

Contest::Predictions Contest::predictions(const Problem& problem, const PlannedTrials& planned, std::size_t i,
                                          std::size_t j) const {
  const auto linear = planned.linearised(trial_, edits_of(problem, *fits_[0]), directions_, true);
  const MatrixXd plain = linear.plain * transform_;
  const auto& c = columns_[j];
  VectorXd first = -linear.residual;
  if (columns_[i].difference > 0) first += plain.col(columns_[i].difference);
  VectorXd difference = plain * between(i, j);
  if (c.count > 0) {
    const MatrixXd own = fits_[j]->fit.information + gram_.block(c.from, c.from, c.count, c.count);
    difference -= plain.middleCols(c.from, c.count) *
                  own.ldlt().solve(gram_.middleRows(c.from, c.count) * between(i, j));
  }
  Predictions out;
  for (Index k = 0; k < difference.size(); ++k) {
    out.first.push_back(first[k]);
    out.second.push_back(first[k] + difference[k]);
  }
  return out;
}

}  // namespace sandhopper::diagnose
