#include "tools/diagnose/evidence/unknown_law.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>

#include "tools/diagnose/evidence/log_determinant.hpp"
#include "tools/diagnose/evidence/screen.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// ln of the mean over s of exp(u' (H + R^-1 / s^2)^-1 u / 2) / |I + s^2 R H|^1/2.
// H: information, u: score, R^-1: precision, s: Limits::unknown_sizes.
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

}  // namespace

std::vector<UnknownLaw> unknown_laws(const Problem& problem, const Point& point,
                                     const std::vector<double>& times) {
  const auto families = free_families(problem, point);
  const Edits base = edits_for(problem, point.hypothesis, point.tolerances);
  std::vector<Direction> terms;
  std::vector<std::vector<Index>> columns;
  const auto own = static_cast<Index>(point.hypothesis.parameters() + point.tolerances.size());
  for (const auto& family : families) {
    columns.emplace_back();
    for (const auto& term : family.terms) {
      columns.back().push_back(own + 1 + static_cast<Index>(terms.size()));
      terms.push_back({with_term(base, term, kTermStep), kTermStep});
    }
  }
  const AtFit at = linearised_at(problem, point, terms);
  const auto& formed = at.formed.back().grams;  // with the largest errors of form
  std::vector<TrialLinear> linear(formed.size());
  for (std::size_t t = 0; t < linear.size(); ++t) linear[t].gram = formed[t];
  // Eliminate the repeatable errors before the laws, also that of the law's own port and variable: an unknown
  // law must explain more than the model error does.
  const auto errors = static_cast<Index>(problem.repeatable_error.size());
  const auto all = formed.front().rows();
  std::vector<Index> order;
  for (Index i = 0; i <= own; ++i) order.push_back(i);
  for (Index i = all - errors; i < all; ++i) order.push_back(i);
  for (Index i = own + 1; i < all - errors; ++i) order.push_back(i);
  for (auto& trial : linear) trial.gram = MatrixXd(trial.gram(order, order));
  for (auto& of_family : columns)
    for (auto& column : of_family) column += errors;
  VectorXd prior(own + errors);
  prior.head(own) = prior_information(problem, point);
  for (Index i = 0; i < errors; ++i)
    prior[own + i] = std::pow(
        times[static_cast<std::size_t>(problem.repeatable_error.group[static_cast<std::size_t>(i)])], -2);
  const auto grams = eliminated(linear, 1, own + errors, prior);
  std::vector<UnknownLaw> laws;
  for (std::size_t f = 0; f < families.size(); ++f) {
    const MatrixXd precision = knot_correlation(static_cast<Index>(columns[f].size())).inverse();  // R^-1
    const auto [information, score] = pooled(grams, columns[f]);
    laws.push_back({families[f], log_factor_of(information, score, precision)});
  }
  std::ranges::sort(laws, std::greater<>{}, &UnknownLaw::log_factor);
  return laws;
}

}  // namespace sandhopper::diagnose
