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

bool is_same_law(const UnknownLaw& a, const UnknownLaw& b) {
  return a.family.port == b.family.port && a.family.variable == b.family.variable && a.family.sensor == b.family.sensor;
}

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
  for (const auto& gram : without_forms(at, scales.of_trial).grams) {
    linear.emplace_back();
    linear.back().gram = gram(order, order);
  }
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
    law.agreed = held_out.gain > 0.0;
    laws.push_back(std::move(law));
  }
  std::ranges::sort(laws, std::greater<>{}, &UnknownLaw::log_factor);
  return laws;
}

Fit with_law_fitted(const Problem& problem, const Fit& at, UnknownLaw& law) {
  constexpr double kGoodStart = 0.7;  // of the deviance without the law
  const FitOptions refit{.max_iterations = 10, .tolerance = 0.5};
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
  if (best.point.hypothesis.law.empty()) return at;
  const auto first = static_cast<Index>(best.point.hypothesis.parameters()), n = static_cast<Index>(terms);
  const auto all = best.information.rows();
  const MatrixXd covariance = best.information.ldlt().solve(MatrixXd::Identity(all, all));
  for (Index k = 0; k < n; ++k) {
    law.size[k] = best.point.hypothesis.law_sizes[static_cast<std::size_t>(k)];
    law.sd[k] = std::sqrt(std::max(0.0, covariance(first + k, first + k)));
  }
  return best;
}

std::vector<LawBeside> weighed_laws(const Problem& problem, const std::vector<std::size_t>& set, const Fit& fit,
                                    const std::vector<UnknownLaw>& laws, std::size_t most) {
  std::vector<LawBeside> out;
  for (const auto& law : laws) {
    if (out.size() == most) break;
    const auto same_port = [&](const LawBeside& other) {
      return other.law.family.port == law.family.port && other.law.family.sensor == law.family.sensor;
    };
    if (std::ranges::count_if(out, same_port) >= (set.empty() ? 2 : 4)) continue;
    // In another variable the same law.
    if (std::ranges::any_of(out, [&](const LawBeside& other) {
          return same_port(other) && std::abs(other.law.log_factor - law.log_factor) < 1e-6 * std::abs(law.log_factor);
        }))
      continue;
    LawBeside one{set, law, {}, 0.0, false};
    one.fit = with_law_fitted(problem, fit, one.law);
    if (one.fit.point.hypothesis.law.empty()) continue;
    const AtFit at = linearised_at(problem, one.fit.point, nullptr);
    one.log_mass = log_evidence(problem, one.fit, at).value + log_prior(problem, set.size()) +
                   std::log(kLimits.unknown_expected / static_cast<double>(laws.size()));
    one.law.gain = fit.deviance - one.fit.deviance;
    one.agreed = p_of_drops(fit.trial_deviance, one.fit.trial_deviance) <= kLimits.trials_agree;
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace sandhopper::diagnose
