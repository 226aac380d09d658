#include "tools/diagnose/evidence/log_evidence.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/diagnose/evidence/form_error.hpp"
#include "tools/diagnose/evidence/log_determinant.hpp"
#include "tools/diagnose/fit/fit.hpp"

namespace sandhopper::diagnose {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

double log_integral_over_size(double best, double sd, bool either_sign) {
  // Midpoint rule in ln|b|. The grid covers only the part that contributes.
  const double spread = kLimits.size_spread;
  const auto density = [&](double b) {  // Prior density per unit of b.
    const double l = std::log(std::abs(b)) / spread;
    return std::exp(-0.5 * l * l) / (std::abs(b) * spread * std::sqrt(2.0 * std::numbers::pi)) *
           (either_sign ? 0.5 : 1.0);
  };
  double sum = 0.0;
  constexpr int kPoints = 400;
  for (const double sign : {1.0, -1.0}) {
    if (sign < 0.0 && !either_sign) continue;
    // Limits: eight standard deviations of the likelihood, six of the prior.
    const double low = std::max(std::exp(-6.0 * spread), sign * best - 8.0 * sd);
    const double high = std::min(std::exp(6.0 * spread), sign * best + 8.0 * sd);
    if (!(high > low)) continue;
    const double from = std::log(low), step = (std::log(high) - from) / kPoints;
    for (int i = 0; i < kPoints; ++i) {
      const double b = std::exp(from + (i + 0.5) * step);
      const double z = (sign * b - best) / sd;
      sum += density(b) * std::exp(-0.5 * z * z) * b * step;
    }
  }
  return std::log(std::max(sum, 1e-300));
}

double log_prior(const Problem& problem, const std::vector<std::size_t>& set) {
  return static_cast<double>(set.size()) *
             std::log(kLimits.effects_expected / static_cast<double>(problem.candidates.size())) +
         log_prior_of_statements(problem, set);
}

double log_prior_of_statements(const Problem& problem, const std::vector<std::size_t>& set) {
  const auto contradicted = std::ranges::count_if(
      set, [&](std::size_t candidate) { return problem.candidates[candidate].contradicts_belief; });
  return static_cast<double>(contradicted) * std::log(kLimits.statement_wrong);
}

AtFit linearised_at(const Problem& problem, const Point& point, const std::vector<Direction>& more,
                    std::span<const double> form_shares) {
  auto directions = parameter_directions(problem, point);
  directions.insert(directions.end(), more.begin(), more.end());
  const auto forms = laws_of(problem, point.hypothesis);
  const auto effects = static_cast<Index>(forms.size());
  const auto linear = linearise_all(
      problem, point, directions,
      {.forms = &forms, .with_repeatable_error = problem.repeatable_error.size() > 0, .fresh_columns = true});
  // Columns: [residual, directions | forms | repeatable error]. The forms differ between trials, so they are
  // eliminated trial by trial.
  const auto before = static_cast<Index>(directions.size()) + 1;
  std::vector<Index> shared, of_form;
  for (Index i = 0; i < linear.front().gram.rows(); ++i)
    (i >= before && i < before + effects * kFormKnots ? of_form : shared).push_back(i);
  AtFit out;
  for (const auto& trial : linear) out.plain.emplace_back(trial.gram(shared, shared));
  for (const double share : forms.empty() ? form_shares.first(1) : form_shares) {
    const MatrixXd information = form_information(effects, share);
    AtFit::Formed& formed = out.formed.emplace_back();
    for (const auto& trial : linear) {
      auto without = without_forms(trial.gram, shared, of_form, information);
      formed.grams.push_back(std::move(without.gram));
      formed.log_determinants.push_back(without.log_determinant + trial.log_determinant);
    }
  }
  return out;
}

namespace {

// -2 ln(posterior density) near a point, without the priors of the first amplitudes, as a quadratic in x:
//   deviance - 2 score' x + x' information x,   x: change of the effects' parameters, the tolerances and the
//   repeatable errors
struct Quadratic {
  MatrixXd information;
  VectorXd score;
  VectorXd prior;         // Diagonal of the prior information.
  double deviance = 0.0;  // Prior and trials together, at the point.

  double least() const { return deviance - score.dot(information.ldlt().solve(score)); }
};

// Added to the information of a first amplitude, so that the matrix stays invertible if no trial shows that
// amplitude.
constexpr double kBarely = 1e-4;
// Prior information that holds a repeatable error at zero if its effect is in the set.
constexpr double kNamed = 1e12;

// `weights`: number of times that each trial counts. `times`: ratio of each group of repeatable errors in
// this campaign to its learnt scale.
Quadratic quadratic_at(const Problem& problem, const Point& point, const std::vector<MatrixXd>& grams,
                       const VectorXd& weights, const std::vector<double>& times) {
  const Hypothesis& h = point.hypothesis;
  const auto parameters = static_cast<Index>(h.parameters());
  const auto tolerances = static_cast<Index>(point.tolerances.size());
  const auto errors = static_cast<Index>(problem.repeatable_error.size());
  const Index k = parameters + tolerances + errors;
  Quadratic q{MatrixXd::Zero(k, k), VectorXd::Zero(k), VectorXd::Zero(k)};
  for (std::size_t t = 0; t < grams.size(); ++t) {
    const double weight = weights[static_cast<Index>(t)];
    q.information += weight * grams[t].block(1, 1, k, k);
    q.score += weight * grams[t].col(0).segment(1, k);
    q.deviance += weight * grams[t](0, 0);
  }
  Index i = 0;
  for (std::size_t e = 0; e < h.candidates.size(); ++e) {
    const auto& p = problem.candidates[h.candidates[e]].parameters;
    for (std::size_t j = 0; j < p.size(); ++j, ++i) {
      if (j == 0) {
        q.information(i, i) += kBarely;
        continue;
      }
      const double centre = is_amplitude(p, j) ? 0.0 : p[j].typical;
      const double offset = (h.values[e][j] - centre) / p[j].typical;
      q.prior[i] = 1.0;
      q.score[i] -= offset;
      q.deviance += offset * offset;
    }
  }
  const VectorXd held = prior_information(problem, point);
  for (Index t = 0; t < tolerances; ++t) {
    const double value = point.tolerances[static_cast<std::size_t>(t)];
    q.prior[parameters + t] = held[parameters + t];
    q.score[parameters + t] -= value;
    q.deviance += value * value;
  }
  const auto& repeatable = problem.repeatable_error;
  for (Index i = 0; i < errors; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const bool named =
        repeatable.candidate[at] != RepeatableError::kNoCandidate && h.contains(repeatable.candidate[at]);
    q.prior[parameters + tolerances + i] =
        named ? kNamed : std::pow(times[static_cast<std::size_t>(repeatable.group[at])], -2);
  }
  q.information.diagonal() += q.prior;
  return q;
}

// ln of the half-normal prior of the ratios, without its constant.
double log_hyperprior(const std::vector<double>& times) {
  double sum = 0.0;
  for (const double one : times) sum -= 0.5 * one * one;
  return sum;
}

// Log evidence without the priors of the first amplitudes: those hardly depend on the ratios `times`.
double value_of(const Quadratic& q) {
  double of_prior = 0.0;
  for (Index i = 0; i < q.prior.size(); ++i)
    if (q.prior[i] > 0.0) of_prior += std::log(q.prior[i]);
  return -0.5 * q.least() + 0.5 * (of_prior - log_determinant(q.information));
}

std::size_t groups_of(const Problem& problem) {
  int most = -1;
  for (const int group : problem.repeatable_error.group) most = std::max(most, group);
  return static_cast<std::size_t>(most + 1);
}

// Coordinate search over `Limits::repeatable_sizes`, starting at 1 (the learnt scale) for every group.
std::vector<double> likeliest_times(const Problem& problem, const Point& point,
                                    const std::vector<MatrixXd>& grams) {
  std::vector<double> times(groups_of(problem), 1.0);
  const VectorXd once = VectorXd::Ones(static_cast<Index>(grams.size()));
  const auto value = [&](const std::vector<double>& t) {
    return value_of(quadratic_at(problem, point, grams, once, t)) + log_hyperprior(t);
  };
  double most = value(times);
  for (double& one : times) {
    const double before = one;
    double best = before;
    for (const double size : kLimits.repeatable_sizes) {
      one = size;
      if (const double v = value(times); v > most) {
        most = v;
        best = size;
      }
    }
    one = best;
  }
  return times;
}

// Deviance of each trial at the fit beyond that of the quadratic there. The fit has the least deviance that
// the simulation reaches, so the linear approximation only counts for what form errors and larger repeatable
// errors change; what it promises beyond that is shared by all trials.
VectorXd beyond_quadratic(const Problem& problem, const Fit& fit, const std::vector<MatrixXd>& plain) {
  const auto trials = static_cast<Index>(plain.size());
  const Quadratic q = quadratic_at(problem, fit.point, plain, VectorXd::Ones(trials),
                                   std::vector<double>(groups_of(problem), 1.0));
  VectorXd off = VectorXd::Constant(trials, (q.deviance - q.least()) / static_cast<double>(trials));
  for (Index t = 0; t < trials; ++t) {
    const auto at = static_cast<std::size_t>(t);
    off[t] += fit.trial_deviance[at] - plain[at](0, 0);
  }
  return off;
}

// The log evidence with one share of the form errors. `off`: of beyond_quadratic.
double log_evidence_of(const Problem& problem, const Fit& fit, const VectorXd& off, const AtFit::Formed& at,
                       const VectorXd& weights, const std::vector<double>& times) {
  const Hypothesis& h = fit.point.hypothesis;
  const Quadratic q = quadratic_at(problem, fit.point, at.grams, weights, times);
  const Eigen::Map<const VectorXd> determinants(at.log_determinants.data(), weights.size());
  double value = value_of(q) + log_hyperprior(times) - 0.5 * weights.dot(off + determinants);
  const Index k = q.score.size();
  const MatrixXd covariance = q.information.ldlt().solve(MatrixXd::Identity(k, k));
  const VectorXd step = covariance * q.score;
  Index first = 0;
  for (std::size_t e = 0; e < h.candidates.size(); ++e) {
    const auto& p = problem.candidates[h.candidates[e]].parameters;
    const double sd = std::sqrt(std::max(covariance(first, first), 1e-300));
    // The determinant stands for a flat prior: its integral is sqrt(2 pi) sd. Replace that by the integral
    // over the prior of the size.
    value += log_integral_over_size(h.values[e][0] / p[0].typical + step[first], sd, p[0].low < 0.0) -
             std::log(sd);
    first += static_cast<Index>(p.size());
  }
  return value;
}

double log_mean(const std::vector<double>& values) {
  const double most = *std::ranges::max_element(values);
  double sum = 0.0;
  for (const double value : values) sum += std::exp(value - most);
  return most + std::log(sum / static_cast<double>(values.size()));
}

}  // namespace

std::vector<LogEvidence> log_evidence_by_form(const Problem& problem, const Fit& fit, const AtFit& at) {
  const VectorXd off = beyond_quadratic(problem, fit, at.plain);
  const VectorXd once = VectorXd::Ones(off.size());
  std::vector<LogEvidence> all;
  for (const auto& formed : at.formed) {
    auto times = likeliest_times(problem, fit.point, formed.grams);
    const double value = log_evidence_of(problem, fit, off, formed, once, times);
    all.push_back({value, std::move(times)});
  }
  return all;
}

LogEvidence log_evidence(const Problem& problem, const Fit& fit, const AtFit& at) {
  const auto all = log_evidence_by_form(problem, fit, at);
  LogEvidence out = *std::ranges::max_element(all, {}, &LogEvidence::value);
  std::vector<double> values;
  for (const auto& one : all) values.push_back(one.value);
  out.value = log_mean(values);
  return out;
}

std::vector<double> weighted_log_evidence(const Problem& problem, const Fit& fit, const AtFit& at,
                                          const MatrixXd& weights) {
  const VectorXd off = beyond_quadratic(problem, fit, at.plain);
  std::vector<std::vector<double>> by_form(static_cast<std::size_t>(weights.cols()));
  for (const auto& formed : at.formed) {
    const auto times = likeliest_times(problem, fit.point, formed.grams);
    for (Index i = 0; i < weights.cols(); ++i)
      by_form[static_cast<std::size_t>(i)].push_back(
          log_evidence_of(problem, fit, off, formed, weights.col(i), times));
  }
  std::vector<double> out;
  for (const auto& values : by_form) out.push_back(log_mean(values));
  return out;
}

}  // namespace sandhopper::diagnose
