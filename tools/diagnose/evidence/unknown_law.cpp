#include "tools/diagnose/evidence/unknown_law.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>

#include "tools/diagnose/evidence/log_determinant.hpp"
#include "tools/diagnose/screen.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// ln mean over s of exp(u' (H + R^-1 / s^2)^-1 u / 2) / |I + s^2 R H|^1/2.
double log_factor_of(const MatrixXd& information, const VectorXd& score, const MatrixXd& precision) {
  std::vector<double> terms;
  for (const double s : kLimits.unknown_sizes) {
    const MatrixXd prior = precision / (s * s);
    const MatrixXd posterior = information + prior;
    terms.push_back(0.5 * score.dot(posterior.ldlt().solve(score)) -
                    0.5 * (log_determinant(posterior) - log_determinant(prior)));
  }
  const double most = *std::ranges::max_element(terms);
  double sum = 0.0;
  for (const double term : terms) sum += std::exp(term - most);
  return most + std::log(sum / static_cast<double>(terms.size()));
}

// One-sided p of the mean of held-out gains; signed square roots, so that one trial with a huge gain is not
// the evidence of many.
double p_of(const std::vector<double>& gains) {
  const double n = static_cast<double>(gains.size());
  if (n < 2.0) return 1.0;
  double sum = 0.0, squares = 0.0;
  for (const double g : gains) {
    const double x = std::copysign(std::sqrt(std::abs(g)), g);
    sum += x;
    squares += x * x;
  }
  const double mean = sum / n, variance = std::max(squares - n * mean * mean, 1e-300) / (n - 1.0);
  const double t = mean / std::sqrt(variance / n);
  return t <= 0.0 ? 1.0 : 0.5 * student_t_two_sided(t, n - 1.0);
}

}  // namespace

std::vector<UnknownLaw> unknown_laws(const Problem& problem, const Point& point,
                                     const ErrorScales& scales, const Signatures& signatures) {
  const auto own = static_cast<Index>(point.hypothesis.parameters() + point.tolerances.size());
  std::vector<Index> taken;
  std::vector<std::vector<Index>> columns;
  for (const auto& law : signatures.laws) {
    columns.emplace_back();
    for (Index i = 0; i < static_cast<Index>(law.family.terms.size()); ++i) {
      columns.back().push_back(own + 1 + static_cast<Index>(taken.size()));
      taken.push_back(law.first + i);
    }
  }
  std::vector<MatrixXd> more;
  for (const auto& all : signatures.columns) more.emplace_back(all(Eigen::all, taken));
  const AtFit at = linearised_at(problem, point, nullptr, &more);
  std::vector<TrialLinear> linear;
  // Repeatable error of the port's own law in this variable stays: an unknown one is larger.
  const Index errors = at.shared_forms + at.repeatable;
  std::vector<Index> order;
  for (Index i = 0; i <= own; ++i) order.push_back(i);
  for (Index i = 0; i < errors; ++i) order.push_back(own + 1 + at.more + i);
  for (Index i = 0; i < at.more; ++i) order.push_back(own + 1 + i);
  for (const auto& gram : without_forms(at, scales.of_trial).grams) linear.push_back({gram(order, order), {}, {}, {}});
  for (auto& of_family : columns)
    for (auto& column : of_family) column += errors;
  VectorXd prior(own + errors);
  prior.head(own) = prior_information(problem, point);
  prior.tail(errors) = error_information(problem, point.hypothesis, at, scales);
  const auto grams = eliminated(linear, 1, own + errors, prior);
  std::vector<UnknownLaw> laws;
  for (std::size_t f = 0; f < columns.size(); ++f) {
    const auto k = static_cast<Index>(columns[f].size());
    const MatrixXd precision = free_law_information(columns[f].size()) / kFreeLawInformation;  // R^-1
    MatrixXd information = MatrixXd::Zero(k, k);
    VectorXd score = VectorXd::Zero(k);
    for (const auto& gram : grams)
      for (Index i = 0; i < k; ++i) {
        score[i] += gram(columns[f][static_cast<std::size_t>(i)], 0);
        for (Index j = 0; j < k; ++j)
          information(i, j) +=
              gram(columns[f][static_cast<std::size_t>(i)], columns[f][static_cast<std::size_t>(j)]);
      }
    UnknownLaw law{signatures.laws[f].family, log_factor_of(information, score, precision), 0.0, 0.0, 1.0, false, {}, {}};
    const MatrixXd held = information + free_law_information(columns[f].size());
    const MatrixXd covariance = held.ldlt().solve(MatrixXd::Identity(k, k));
    law.size = covariance * score;
    law.sd = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
    law.gain = score.dot(law.size);
    const auto held_out = held_out_gain(grams, columns[f], free_law_information(columns[f].size()));
    law.held_out = held_out.gain;
    law.p_value = p_of(held_out.of_trial);
    const bool can_say = static_cast<double>(problem.trials.size()) >= kLimits.flips_from_trials;
    law.agreed = held_out.gain > 0.0 && (!can_say || law.p_value <= kLimits.flips);
    laws.push_back(std::move(law));
  }
  std::ranges::sort(laws, std::greater<>{}, &UnknownLaw::log_factor);
  return laws;
}

Point with_law_fitted(const Problem& problem, const Fit& at, UnknownLaw& law) {
  constexpr double kWorthAStep = 0.005, kGoodStart = 0.7;  // of the deviance without the law
  const FitOptions refit{.max_iterations = 6, .tolerance = kWorthAStep * at.deviance};
  const auto terms = law.family.terms.size();
  Fit best = at;
  // From where its linear approximation, or the balance, has it; if that leads nowhere, from nothing.
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
