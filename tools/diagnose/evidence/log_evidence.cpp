#include "tools/diagnose/evidence/log_evidence.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/diagnose/evidence/log_determinant.hpp"
#include "tools/diagnose/fit.hpp"
#include "tools/diagnose/free_laws.hpp"
#include "tools/diagnose/screen.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// L with L L' = covariance of the form and size of one effect in one trial, over the knots of FormOf.
MatrixXd form_factor() {
  const MatrixXd covariance = (kLimits.form * kLimits.form * knot_correlation(kFormKnots)).array() +
                              kLimits.size_of_trial * kLimits.size_of_trial;
  return covariance.llt().matrixL();
}

// The same of what trials share, along one coordinate.
MatrixXd shared_form_factor() {
  const MatrixXd covariance = kLimits.form * kLimits.form * knot_correlation(kSharedFormKnots);
  return covariance.llt().matrixL();
}

// One effect trial by trial: score and information of its size along its fitted amplitudes, with the effect
// put back into the residual, everything else eliminated over all trials together.
TrialEvidence of_trials(const Problem& problem, const Hypothesis& h, const std::vector<MatrixXd>& grams,
                        std::size_t effect, const VectorXd& prior) {
  std::vector<Index> own, others;
  VectorXd along;
  Index column = 1;
  std::vector<double> sizes;
  for (std::size_t e = 0; e < h.candidates.size(); ++e) {
    const auto& p = problem.candidates[h.candidates[e]].parameters;
    for (std::size_t j = 0; j < p.size(); ++j, ++column)
      if (e == effect && is_amplitude(p, j)) {
        own.push_back(column);
        sizes.push_back(h.values[e][j] / p[j].typical);
      } else {
        others.push_back(column);
      }
  }
  for (; column <= prior.size(); ++column) others.push_back(column);
  const auto n = static_cast<Index>(others.size());
  // Columns: residual with the effect put back, the effect, all others.
  std::vector<TrialLinear> trials;
  VectorXd held(n);
  for (Index i = 0; i < n; ++i)
    held[i] = std::max(prior[others[static_cast<std::size_t>(i)] - 1], 1e-4);
  for (const auto& gram : grams) {
    MatrixXd transform = MatrixXd::Zero(gram.rows(), 2 + n);
    transform(0, 0) = 1.0;
    for (std::size_t i = 0; i < own.size(); ++i) transform(own[i], 0) = transform(own[i], 1) = sizes[i];
    for (Index i = 0; i < n; ++i) transform(others[static_cast<std::size_t>(i)], 2 + i) = 1.0;
    trials.emplace_back();
    trials.back().gram = transform.transpose() * gram * transform;
  }
  TrialEvidence evidence;
  for (const auto& gram : eliminated(trials, 2, n, held)) {
    evidence.score.push_back(gram(1, 0));
    evidence.information.push_back(std::max(gram(1, 1), 0.0));
  }
  return evidence;
}

}  // namespace

double log_integral_over_size(double best, double sd, bool either_sign) {
  // By the midpoint rule in ln|b|, on a grid that spans the peak of the likelihood only.
  const double spread = kLimits.size_spread;
  const auto density = [&](double b) {  // of the prior, per unit of b
    const double l = std::log(std::abs(b)) / spread;
    return std::exp(-0.5 * l * l) / (std::abs(b) * spread * std::sqrt(2.0 * std::numbers::pi)) *
           (either_sign ? 0.5 : 1.0);
  };
  double sum = 0.0;
  constexpr int kPoints = 400;
  for (const double sign : {1.0, -1.0}) {
    if (sign < 0.0 && !either_sign) continue;
    // Where the likelihood is within eight standard deviations and the prior within six.
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

double log_prior(const Problem& problem, std::size_t effects) {
  return static_cast<double>(effects) *
         std::log(kLimits.effects_expected / static_cast<double>(problem.candidates.size()));
}

AtFit linearised_at(const Problem& problem, const Point& point, const std::vector<KeptColumns>* columns,
                    const std::vector<MatrixXd>* more) {
  auto directions = parameter_directions(problem, point);
  std::vector<FormOf> forms;
  std::size_t parameter = 0;
  for (std::size_t e = 0; e < point.hypothesis.candidates.size(); ++e) {
    const auto& parameters = problem.candidates[point.hypothesis.candidates[e]].parameters;
    FormOf form;
    for (std::size_t j = 0; j < parameters.size(); ++j, ++parameter)
      if (is_amplitude(parameters, j))
        form.directions.emplace_back(parameter, point.hypothesis.values[e][j] / parameters[j].typical);
    forms.push_back(std::move(form));
  }
  const auto linear = linearise_all(
      problem, point, directions,
      {.forms = &forms, .more = more, .with_repeatable_error = true, .with_own_error = true, .columns = columns});
  AtFit out;
  out.effects = static_cast<Index>(forms.size());
  out.directions = static_cast<Index>(directions.size());
  const Index axes = static_cast<Index>(problem.form_knots.size()), of_trial = out.effects * kFormKnots;
  out.shared_forms = out.effects * axes * kSharedFormKnots;
  out.more = more != nullptr ? more->front().cols() : 0;
  out.repeatable = static_cast<Index>(problem.repeatable_error.size());
  // As they come: residual, directions, forms of the trial, those that are shared, more, repeatable errors.
  std::vector<Index> order;
  const auto take = [&](Index first, Index count) {
    for (Index i = 0; i < count; ++i) order.push_back(first + i);
  };
  const Index first_form = 1 + out.directions, first_shared = first_form + of_trial,
              first_more = first_shared + out.shared_forms;
  take(0, first_form);
  take(first_more, out.more);
  take(first_shared, out.shared_forms);
  take(first_more + out.more, out.repeatable);
  take(first_form, of_trial);
  MatrixXd scale = MatrixXd::Identity(static_cast<Index>(order.size()), static_cast<Index>(order.size()));
  const MatrixXd shared = shared_form_factor(), own = form_factor();
  for (Index f = 0; f < out.effects * axes; ++f) {
    const Index at = 1 + out.directions + out.more + f * kSharedFormKnots;
    scale.block(at, at, kSharedFormKnots, kSharedFormKnots) = shared;
  }
  for (Index f = 0; f < out.effects; ++f) {
    const Index at = out.shared() + f * kFormKnots;
    scale.block(at, at, kFormKnots, kFormKnots) = own;
  }
  const auto known = static_cast<Index>(order.size());
  for (const auto& trial : linear) {
    out.log_determinant += trial.log_determinant;
    auto all = order;
    for (Index i = known; i < trial.gram.rows(); ++i) all.push_back(i);
    out.trials.emplace_back(trial.gram(all, all));
    MatrixXd& gram = out.trials.back();
    gram.topRows(known) = scale.transpose() * gram.topRows(known).eval();
    gram.leftCols(known) = gram.leftCols(known).eval() * scale;
  }
  return out;
}

WithoutForms without_forms(const AtFit& at, const std::vector<double>& of_trial) {
  WithoutForms out;
  const Index shared = at.shared(), of_effects = at.effects * kFormKnots;
  for (const auto& gram : at.trials) {
    const Index n = gram.rows() - shared;
    out.grams.emplace_back(gram.topLeftCorner(shared, shared));
    if (n == 0) continue;
    VectorXd prior = VectorXd::Constant(n, std::pow(of_trial.back(), -2));
    for (Index i = 0; i < of_effects; ++i)
      prior[i] = std::pow(of_trial[static_cast<std::size_t>(i / kFormKnots)], -2);
    MatrixXd held = gram.bottomRightCorner(n, n);
    held.diagonal() += prior;
    const Eigen::LLT<MatrixXd> solver(held);
    const MatrixXd cross = gram.topRightCorner(shared, n);
    const MatrixXd half = solver.matrixL().solve(cross.transpose());
    out.grams.back() -= half.transpose() * half;
    out.log_determinant += 2.0 * MatrixXd(solver.matrixLLT()).diagonal().array().abs().log().sum() -
                           prior.array().log().sum();
  }
  return out;
}

namespace {

// Minus twice the logarithm of posterior density around a point, without the amplitudes' own priors:
//   deviance - 2 score' x + x' information x,  x the change of effects' parameters and tolerances
struct Quadratic {
  MatrixXd information;
  VectorXd score;
  VectorXd prior;         // information that was there beforehand
  double deviance = 0.0;  // of priors and trials at the point
  double log_prior_of_law = 0.0;

  double least() const { return deviance - score.dot(information.ldlt().solve(score)); }
};

// An amplitude that nothing shows keeps the solution finite by a little.
constexpr double kBarely = 1e-4;
constexpr double kNothing = 1e-6;  // of a scale
constexpr double kAbsent = 1e10;   // prior information of what is not there
constexpr double kWorthAStep = 0.5;
constexpr int kMostSteps = 8;
constexpr double kNamed = 1e12;  // holds the error of an effect that is in the set at nothing

Quadratic quadratic_at(const Problem& problem, const Point& point, const AtFit& at,
                       const std::vector<MatrixXd>& grams, const ErrorScales& scales) {
  const Hypothesis& h = point.hypothesis;
  const auto terms = static_cast<Index>(h.law.size());
  const auto parameters = static_cast<Index>(h.parameters());
  const auto tolerances = static_cast<Index>(point.tolerances.size());
  std::vector<Index> taken;
  for (Index i = 1; i < at.shared(); ++i)
    if (i <= at.directions || i > at.directions + at.more) taken.push_back(i);
  const auto k = static_cast<Index>(taken.size());
  Quadratic q{MatrixXd::Zero(k, k), VectorXd::Zero(k), VectorXd::Zero(k)};
  for (const auto& gram : grams) {
    q.information += gram(taken, taken);
    q.score += gram(taken, 0);
    q.deviance += gram(0, 0);
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
    q.prior[parameters + terms + t] = held[parameters + t];
    q.score[parameters + terms + t] -= value;
    q.deviance += value * value;
  }
  if (terms > 0) {
    const MatrixXd precision = knot_correlation(terms).inverse() / (scales.law * scales.law);
    const VectorXd sizes = Eigen::Map<const VectorXd>(h.law_sizes.data(), terms);
    q.information.block(parameters, parameters, terms, terms) += precision;
    q.score.segment(parameters, terms) -= precision * sizes;
    q.deviance += sizes.dot(precision * sizes);
    q.log_prior_of_law = log_determinant(precision);
  }
  q.prior.tail(at.shared_forms + at.repeatable) = error_information(problem, h, at, scales);
  q.information.diagonal() += q.prior;
  return q;
}

// Half-normal; of forces of one trial alone, which nobody learned, half-Cauchy. A group that is no model error
// is an unknown law.
double log_hyperprior(const Problem& problem, const ErrorScales& scales) {
  double sum = 0.0;
  for (const double one : scales.form) sum -= 0.5 * one * one;
  for (std::size_t i = 0; i + 1 < scales.of_trial.size(); ++i) sum -= 0.5 * std::pow(scales.of_trial[i], 2);
  sum -= std::log1p(std::pow(scales.of_trial.back(), 2));
  const auto& groups = problem.repeatable_error.groups;
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (is_unknown(problem, scales, g))
      sum += std::log(kLimits.unknown_expected / static_cast<double>(groups.size()));
    else
      sum -= 0.5 * std::pow(scales.repeatable[g], 2);
  return sum;
}

// Without the amplitudes' priors, which hardly know of it.
double value_of(const Quadratic& q) {
  double of_prior = q.log_prior_of_law;
  for (Index i = 0; i < q.prior.size(); ++i)
    if (q.prior[i] > 0.0) of_prior += std::log(q.prior[i]);
  return -0.5 * q.least() + 0.5 * (of_prior - log_determinant(q.information));
}

ErrorScales as_learned(const Problem& problem, const AtFit& at) {
  const auto effects = static_cast<std::size_t>(at.effects);
  ErrorScales scales{{}, std::vector<double>(effects, 1.0), std::vector<double>(effects + 1, 1.0)};
  for (const auto& group : problem.repeatable_error.groups) scales.repeatable.push_back(group.expected ? 1.0 : 0.0);
  return scales;
}

// What the evidence gains where a group of errors has another scale: ln Z(s) - ln Z(now), from the posterior
// of its columns alone, u'(F + P)^-1 u / 2 - ln|I + F / P| / 2 with F, u their information and score with all
// else eliminated, P = s^-2.
struct OfGroup {
  MatrixXd information;
  VectorXd score;

  double value(double size) const {
    if (size <= 0.0) return 0.0;
    const double prior = std::pow(size, -2);
    MatrixXd held = information;
    held.diagonal().array() += prior;
    return 0.5 * score.dot(held.ldlt().solve(score)) -
           0.5 * (log_determinant(held) - static_cast<double>(score.size()) * std::log(prior));
  }
};

OfGroup of_group(const Quadratic& q, const std::vector<Index>& columns) {
  std::vector<std::uint8_t> own(static_cast<std::size_t>(q.score.size()), 0);
  for (const Index c : columns) own[static_cast<std::size_t>(c)] = 1;
  std::vector<Index> others;
  for (Index i = 0; i < q.score.size(); ++i)
    if (own[static_cast<std::size_t>(i)] == 0 && q.prior[i] < kAbsent) others.push_back(i);
  const Eigen::LDLT<MatrixXd> rest(q.information(others, others));
  const MatrixXd cross = q.information(others, columns);
  OfGroup out;
  out.information = q.information(columns, columns) - cross.transpose() * rest.solve(cross);
  for (std::size_t i = 0; i < columns.size(); ++i)
    out.information(static_cast<Index>(i), static_cast<Index>(i)) -= q.prior[columns[i]];
  out.score = q.score(columns) - cross.transpose() * rest.solve(q.score(others));
  return out;
}

// One scale after the other, from `scales`; with `unknown` a group may be larger than model error.
void improve(const Problem& problem, const Point& point, const AtFit& at, bool unknown, ErrorScales& scales) {
  const auto& groups = problem.repeatable_error.groups;
  const Index first_form = at.directions, first_error = at.directions + at.shared_forms;
  const Index of_effect = at.effects > 0 ? at.shared_forms / at.effects : 0;
  for (int round = 0; round < 2; ++round) {
    WithoutForms without = without_forms(at, scales.of_trial);
    const auto value = [&] {
      return value_of(quadratic_at(problem, point, at, without.grams, scales)) +
             log_hyperprior(problem, scales) - 0.5 * without.log_determinant;
    };
    double most = value();
    for (std::size_t i = 0; i < scales.of_trial.size(); ++i) {
      double& one = scales.of_trial[i];
      double best = one;
      const bool forces = i + 1 == scales.of_trial.size();
      if (forces && at.trials.front().rows() - at.shared() == at.effects * kFormKnots) continue;
      for (const double size : forces ? std::vector<double>(kLimits.force_sizes.begin(), kLimits.force_sizes.end())
                                      : std::vector<double>(kLimits.error_sizes.begin(), kLimits.error_sizes.end())) {
        one = size;
        without = without_forms(at, scales.of_trial);
        if (const double v = value(); v > most) {
          most = v;
          best = size;
        }
      }
      one = best;
      without = without_forms(at, scales.of_trial);
    }
    for (int step = 0; step < kMostSteps; ++step) {
      const Quadratic q = quadratic_at(problem, point, at, without.grams, scales);
      const double prior_now = log_hyperprior(problem, scales);
      double gain = kWorthAStep, best = 0.0;
      double* chosen = nullptr;
      const auto try_sizes = [&](double& one, const std::vector<Index>& columns, const auto& sizes) {
        const OfGroup group = of_group(q, columns);
        const double now = one, value_now = group.value(now);
        for (const double size : sizes) {
          one = size;
          const double more = group.value(size) - value_now + log_hyperprior(problem, scales) - prior_now;
          if (more > gain) gain = more, best = size, chosen = &one;
        }
        one = now;
      };
      for (std::size_t e = 0; e < scales.form.size(); ++e) {
        std::vector<Index> columns;
        for (Index i = 0; i < of_effect; ++i)
          columns.push_back(first_form + static_cast<Index>(e) * of_effect + i);
        try_sizes(scales.form[e], columns, kLimits.error_sizes);
      }
      for (std::size_t g = 0; g < groups.size(); ++g) {
        std::vector<Index> columns;
        for (const Index c : groups[g].columns) {
          const auto candidate = problem.repeatable_error.candidate[static_cast<std::size_t>(c)];
          if (candidate == RepeatableError::kNoCandidate || !point.hypothesis.contains(candidate))
            columns.push_back(first_error + c);
        }
        if (columns.empty()) continue;
        std::vector<double> sizes;
        if (groups[g].expected) sizes.assign(kLimits.error_sizes.begin(), kLimits.error_sizes.end());
        if (unknown && !groups[g].variable.empty())
          for (const double size : kLimits.unknown_sizes) sizes.push_back(size * groups[g].port_scale);
        if (!sizes.empty()) try_sizes(scales.repeatable[g], columns, sizes);
      }
      if (chosen == nullptr) break;
      *chosen = best;
    }
  }
}

// ln of the amplitudes' own priors, in place of the integral sqrt(2 pi) sd of a flat one, which the determinant
// stands for.
double log_sizes(const Problem& problem, const Hypothesis& h, const Quadratic& q) {
  if (h.candidates.empty()) return 0.0;
  const auto parameters = static_cast<Index>(h.parameters());
  const Eigen::LDLT<MatrixXd> solver(q.information);
  const MatrixXd covariance = solver.solve(MatrixXd::Identity(q.score.size(), parameters));
  const VectorXd step = solver.solve(q.score);
  double sum = 0.0;
  Index first = 0;
  for (std::size_t e = 0; e < h.candidates.size(); ++e) {
    const auto& p = problem.candidates[h.candidates[e]].parameters;
    const double sd = std::sqrt(std::max(covariance(first, first), 1e-300));
    sum += log_integral_over_size(h.values[e][0] / p[0].typical + step[first], sd, p[0].either_sign) - std::log(sd);
    first += static_cast<Index>(p.size());
  }
  return sum;
}

}  // namespace

bool is_unknown(const Problem& problem, const ErrorScales& scales, std::size_t group) {
  const auto& g = problem.repeatable_error.groups[group];
  return !g.variable.empty() && scales.repeatable[group] >= kLimits.unknown_sizes.front() * g.port_scale;
}

VectorXd error_information(const Problem& problem, const Hypothesis& hypothesis, const AtFit& at,
                           const ErrorScales& scales) {
  VectorXd information(at.shared_forms + at.repeatable);
  const Index of_effect = at.effects > 0 ? at.shared_forms / at.effects : 1;
  for (Index i = 0; i < at.shared_forms; ++i)
    information[i] = std::pow(scales.form[static_cast<std::size_t>(i / of_effect)], -2);
  const auto& repeatable = problem.repeatable_error;
  for (std::size_t g = 0; g < repeatable.groups.size(); ++g)
    for (const Index i : repeatable.groups[g].columns) {
      const auto candidate = repeatable.candidate[static_cast<std::size_t>(i)];
      const bool named = candidate != RepeatableError::kNoCandidate && hypothesis.contains(candidate);
      const double size = scales.repeatable[g];
      information[at.shared_forms + i] = named || size <= 0.0 ? kNamed : std::pow(size, -2);
    }
  return information;
}

namespace {

LogEvidence with_law_of_scale(const Problem& problem, const Fit& fit, const AtFit& at, double law_scale) {
  const Hypothesis& h = fit.point.hypothesis;
  const auto parameters = static_cast<Index>(h.parameters());
  LogEvidence out;
  out.scales = as_learned(problem, at);
  out.scales.law = law_scale;
  improve(problem, fit.point, at, false, out.scales);
  const WithoutForms without = without_forms(at, out.scales.of_trial);
  const Quadratic q = quadratic_at(problem, fit.point, at, without.grams, out.scales);
  // Without errors of form: where the fit was made.
  AtFit bare = at;
  for (auto& gram : bare.trials) gram = MatrixXd(gram.topLeftCorner(at.shared(), at.shared()));
  ErrorScales none = as_learned(problem, at);
  none.law = law_scale;
  for (double& one : none.form) one = kNothing;
  const Quadratic plain = quadratic_at(problem, fit.point, at, bare.trials, none);
  // The fit is as close as the simulation lets it be; what errors of form, and larger ones of the ports,
  // change is read off the linear approximation.
  double off = 0.0;
  for (std::size_t t = 0; t < at.trials.size(); ++t) off += fit.trial_deviance[t] - at.trials[t](0, 0);
  off += plain.deviance - plain.least();
  out.deviance = q.least() + off;
  out.value = value_of(q) - 0.5 * off + log_hyperprior(problem, out.scales) -
              0.5 * (without.log_determinant + at.log_determinant) + log_sizes(problem, h, q);
  ErrorScales wide = out.scales;
  if (h.law.empty()) improve(problem, fit.point, at, true, wide);
  double largest = 0.0;
  for (std::size_t g = 0; g < wide.repeatable.size(); ++g)
    if (is_unknown(problem, wide, g) &&
        wide.repeatable[g] / problem.repeatable_error.groups[g].port_scale > largest) {
      largest = wide.repeatable[g] / problem.repeatable_error.groups[g].port_scale;
      out.unknown = g;
    }
  if (largest > 0.0) {
    const WithoutForms beside = without_forms(at, wide.of_trial);
    const Quadratic there = quadratic_at(problem, fit.point, at, beside.grams, wide);
    out.with_unknown = value_of(there) - 0.5 * off + log_hyperprior(problem, wide) -
                       0.5 * (beside.log_determinant + at.log_determinant) + log_sizes(problem, h, there);
  }
  const Index k = q.score.size();
  const MatrixXd covariance = q.information.ldlt().solve(MatrixXd::Identity(k, k));
  out.covariance = covariance.topLeftCorner(parameters, parameters);
  for (std::size_t e = 0; e < h.candidates.size(); ++e)
    out.trials.push_back(of_trials(problem, h, without.grams, e, q.prior));
  return out;
}

}  // namespace

LogEvidence log_evidence(const Problem& problem, const Fit& fit, const AtFit& at) {
  if (fit.point.hypothesis.law.empty()) return with_law_of_scale(problem, fit, at, 1.0);
  LogEvidence best;
  best.value = -std::numeric_limits<double>::infinity();
  for (const double scale : kLimits.unknown_sizes)
    if (LogEvidence one = with_law_of_scale(problem, fit, at, scale); one.value > best.value)
      best = std::move(one);
  best.value -= std::log(static_cast<double>(kLimits.unknown_sizes.size()));
  return best;
}

}  // namespace sandhopper::diagnose
