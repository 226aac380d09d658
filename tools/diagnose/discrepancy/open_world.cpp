#include "tools/diagnose/discrepancy/open_world.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "tools/diagnose/fit/fit.hpp"
#include "tools/diagnose/fit/levels.hpp"
#include "tools/diagnose/fit/statistics.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Prior standard deviation of the square root of a trial's gain. Larger than 1, its value for noise alone.
constexpr double kGainSpread = 2.0;
// Factor on the gain of a sensor's law when laws are sorted: a law of the plant is preferred. Set by hand.
constexpr double kSensorHandicap = 0.75;

}  // namespace

double p_of_gains(const std::vector<double>& gains, double spread) {
  const double n = static_cast<double>(gains.size());
  // A single trial shows no scatter: its gain is treated as the square of a normal variable.
  const double alone = spread * normal_quantile(kSignificance);
  if (n < 2.0) return gains.empty() || gains[0] < alone * alone ? 1.0 : kSignificance;
  // Signed square roots, so that one trial with a huge gain does not dominate.
  double sum = 0.0, squares = 0.0;
  for (const double g : gains) {
    const double x = std::copysign(std::sqrt(std::abs(g)), g);
    sum += x;
    squares += x * x;
  }
  const double mean = sum / n;
  const double variance = (spread * spread + squares - n * mean * mean) / (n + 3.0);
  const double t = mean / std::sqrt(variance / n);
  return t <= 0.0 ? 1.0 : 0.5 * student_t_two_sided(t, n + 3.0);
}

std::vector<FreeGain> free_gains(const Problem& problem, const Point& point) {
  auto directions = parameter_directions(problem, point);
  const auto own = static_cast<Index>(directions.size());
  const Edits base = edits_for(problem, point.hypothesis, point.tolerances);
  const auto families = free_families(problem, point);
  std::vector<std::vector<Index>> columns;
  for (const auto& family : families) {
    columns.emplace_back();
    for (const auto& term : family.terms) {
      columns.back().push_back(static_cast<Index>(directions.size()) + 1);
      directions.push_back({with_term(base, term, kTermStep), kTermStep});
    }
  }
  const auto linear = linearise_all(problem, point, directions);
  VectorXd prior = VectorXd::Constant(own, kPriorOfAmplitude);
  prior.tail(static_cast<Index>(point.tolerances.size())).setOnes();
  const auto grams = eliminated(linear, 1, own, prior);
  std::vector<FreeGain> gains;
  for (std::size_t f = 0; f < families.size(); ++f) {
    const MatrixXd prior_of_law = free_law_information(columns[f].size());
    const auto held_out = held_out_gain(grams, columns[f], prior_of_law);
    FreeGain gain{families[f], held_out.gain, 0.0, 1.0, {}, {}};
    for (const double g : held_out.of_trial)
      gain.trials_better += (g > 0.0 ? 1.0 : 0.0) / static_cast<double>(held_out.of_trial.size());
    gain.p_value =
        std::min(1.0, p_of_gains(held_out.of_trial, kGainSpread) * static_cast<double>(families.size()));
    const auto k = static_cast<Index>(columns[f].size());
    const auto [of_data, score] = pooled(grams, columns[f]);
    const MatrixXd information = of_data + prior_of_law;
    const MatrixXd covariance = information.ldlt().solve(MatrixXd::Identity(k, k));
    gain.size = covariance * score;
    gain.sd = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
    gains.push_back(std::move(gain));
  }
  const auto rank = [](const FreeGain& g) { return g.held_out * (g.family.sensor ? kSensorHandicap : 1.0); };
  std::sort(gains.begin(), gains.end(),
            [&](const FreeGain& a, const FreeGain& b) { return rank(a) > rank(b); });
  return gains;
}

Point with_law_fitted(const Problem& problem, const Fit& at, FreeGain& law) {
  constexpr double kWorthAStep = 0.005, kGoodStart = 0.7;  // fractions of the deviance without the law
  const FitOptions refit{.max_iterations = 6, .tolerance = kWorthAStep * at.deviance};
  const auto terms = law.family.terms.size();
  Fit best = at;
  // Start from the linear estimate (or the balance). If that fails, start from zero.
  for (const double share : {1.0, 0.0}) {
    Point start = at.point;
    start.hypothesis.law = law.family.terms;
    for (std::size_t k = 0; k < terms; ++k)
      start.hypothesis.law_sizes.push_back(share * law.size[static_cast<Index>(k)]);
    Fit fit = fit_from(problem, start, refit);
    if (fit.deviance < best.deviance) best = std::move(fit);
    if (best.deviance < kGoodStart * at.deviance) break;
  }
  if (best.point.hypothesis.law.empty()) return at.point;
  const auto first = static_cast<Index>(best.point.hypothesis.parameters()), n = static_cast<Index>(terms);
  const auto all = best.information.rows();
  const MatrixXd covariance = best.information.ldlt().solve(MatrixXd::Identity(all, all));
  for (Index k = 0; k < n; ++k) {
    law.size[k] = best.point.hypothesis.law_sizes[static_cast<std::size_t>(k)];
    law.sd[k] = std::sqrt(std::max(0.0, covariance(first + k, first + k)));
  }
  return best.point;
}

}  // namespace sandhopper::diagnose
