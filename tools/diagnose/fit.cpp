#include "tools/diagnose/fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/experiment/parallel.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kSettled = 0.01;
constexpr double kPriorTypicals = 10.0;
constexpr double kDerivativeStep = 0.005;  // of a parameter's typical size

double prior_deviance(const Problem& problem, const Point& point) {
  double sum = 0.0;
  for (std::size_t i = 0; i < point.hypothesis.candidates.size(); ++i) {
    const auto& parameters = problem.candidates[point.hypothesis.candidates[i]].parameters;
    for (std::size_t j = 0; j < parameters.size(); ++j) {
      // Only shapes need holding: an amplitude is what is asked for.
      const double centre = j == 0 ? 0.0 : parameters[j].typical;
      const double sd = j == 0 ? kPriorTypicals * parameters[j].typical : parameters[j].typical;
      sum += std::pow((point.hypothesis.values[i][j] - centre) / sd, 2);
    }
  }
  for (const double value : point.tolerances) sum += value * value;
  return sum;
}

// Gradient and information of the priors, in units of typical size.
void add_priors(const Problem& problem, const Point& point, MatrixXd& information, VectorXd& score) {
  Index at = 0;
  for (std::size_t i = 0; i < point.hypothesis.candidates.size(); ++i) {
    const auto& parameters = problem.candidates[point.hypothesis.candidates[i]].parameters;
    for (std::size_t j = 0; j < parameters.size(); ++j, ++at) {
      const double centre = j == 0 ? 0.0 : parameters[j].typical;
      const double weight = j == 0 ? 1.0 / (kPriorTypicals * kPriorTypicals) : 1.0;
      information(at, at) += weight;
      score[at] -= weight * (point.hypothesis.values[i][j] - centre) / parameters[j].typical;
    }
  }
  for (const double value : point.tolerances) {
    information(at, at) += 1.0;
    score[at++] -= value;
  }
}

double total(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

// Moves by `step` (typical sizes, then tolerances), inside the bounds. True when a bound was met.
bool move(const Problem& problem, Point& point, const VectorXd& step) {
  bool bounded = false;
  Index at = 0;
  for (std::size_t i = 0; i < point.hypothesis.candidates.size(); ++i) {
    const auto& parameters = problem.candidates[point.hypothesis.candidates[i]].parameters;
    for (std::size_t j = 0; j < parameters.size(); ++j, ++at) {
      double& value = point.hypothesis.values[i][j];
      const double wanted = value + step[at] * parameters[j].typical;
      value = std::clamp(wanted, parameters[j].low, parameters[j].high);
      bounded = bounded || (value != wanted && j == 0);
    }
  }
  for (double& value : point.tolerances)
    value = std::clamp(value + step[at++], -kMostTolerance, kMostTolerance);
  return bounded;
}

}  // namespace

std::vector<double> deviances(const Problem& problem, const Point& point) {
  const Edits edits = edits_for(problem, point.hypothesis, point.tolerances);
  std::vector<double> out(problem.trials.size());
  parallel_for(out.size(), [&](std::size_t t) {
    const TrialModel& trial = *problem.trials[t];
    VectorXd r(static_cast<Index>(trial.rows.size()));
    trial.predict(edits, point.nuisances[t], {r.data(), trial.rows.size()});
    for (Index k = 0; k < r.size(); ++k) {
      r[k] = trial.rows[static_cast<std::size_t>(k)].measured - r[k];
      if (!std::isfinite(r[k])) r[k] = 1e6;
    }
    problem.noise.whiten(trial, problem.used[t], r);
    double sum = r.squaredNorm();
    const std::size_t q = trial.trial_nuisances.size(), nb = trial.block_nuisances.size();
    for (std::size_t i = 0; i < point.nuisances[t].size(); ++i) {
      const double sd = i < q ? trial.trial_nuisances[i].sd : trial.block_nuisances[(i - q) % nb].sd;
      sum += std::pow(point.nuisances[t][i] / sd, 2);
    }
    out[t] = sum;
    __atomic_fetch_add(&problem.simulations, 1, __ATOMIC_RELAXED);
  });
  return out;
}

std::vector<Direction> parameter_directions(const Problem& problem, const Point& point) {
  std::vector<Direction> directions;
  for (std::size_t i = 0; i < point.hypothesis.candidates.size(); ++i) {
    const auto& parameters = problem.candidates[point.hypothesis.candidates[i]].parameters;
    for (std::size_t j = 0; j < parameters.size(); ++j) {
      Hypothesis moved = point.hypothesis;
      double step = kDerivativeStep;
      if (moved.values[i][j] + step * parameters[j].typical > parameters[j].high) step = -step;
      moved.values[i][j] += step * parameters[j].typical;
      directions.push_back({edits_for(problem, moved, point.tolerances), step});
    }
  }
  for (std::size_t i = 0; i < point.tolerances.size(); ++i) {
    directions.push_back({{}, 1.0, static_cast<int>(i)});
  }
  return directions;
}

Fit fit_from(const Problem& problem, const Point& start, const FitOptions& options) {
  Fit fit;
  fit.point = start;
  fit.trial_deviance = deviances(problem, start);
  fit.deviance = total(fit.trial_deviance) + prior_deviance(problem, start);
  double damping = 1e-3;
  bool bounded = false;
  bool stalled = false;
  double last_drop = 0.0;  // of the deviance, relative
  bool fresh = problem.kept_columns.empty();
  for (fit.iterations = 0; fit.iterations < options.max_iterations && !stalled; ++fit.iterations) {
    const auto directions = parameter_directions(problem, fit.point);
    const auto linear = linearise_all(problem, fit.point, directions, {.fresh_columns = fresh});
    const auto k = static_cast<Index>(directions.size());
    MatrixXd information = MatrixXd::Zero(k, k);
    VectorXd score = VectorXd::Zero(k);
    for (const auto& trial : linear) {
      information += trial.gram.bottomRightCorner(k, k);
      score += trial.gram.col(0).tail(k);
    }
    add_priors(problem, fit.point, information, score);
    fit.information = information;
    bool accepted = false;
    for (int attempt = 0; attempt < 5; ++attempt) {
      MatrixXd damped = information;
      damped.diagonal() *= 1.0 + damping;
      const VectorXd step = k > 0 ? VectorXd(damped.ldlt().solve(score)) : VectorXd();
      // A short cut where the whole step overshoots: the nuisances follow the shortened one.
      const double shortening = std::pow(0.5, std::max(0, attempt - 2));
      Point trial_point = fit.point;
      bounded = move(problem, trial_point, shortening * step);
      for (std::size_t t = 0; t < linear.size(); ++t) {
        VectorXd change = linear[t].solution.col(0);
        if (k > 0) change -= linear[t].solution.rightCols(k) * step;
        for (std::size_t i = 0; i < trial_point.nuisances[t].size(); ++i)
          trial_point.nuisances[t][i] += shortening * change[static_cast<Index>(i)];
      }
      const auto trial_deviance = deviances(problem, trial_point);
      const double deviance = total(trial_deviance) + prior_deviance(problem, trial_point);
      if (deviance < fit.deviance) {
        last_drop = (fit.deviance - deviance) / std::max(fit.deviance, 1e-300);
        stalled = fit.deviance - deviance < options.tolerance + 1e-7 * fit.deviance;
        fit.point = std::move(trial_point);
        fit.deviance = deviance;
        fit.trial_deviance = trial_deviance;
        damping = std::max(damping * 0.2, 1e-6);
        accepted = true;
        break;
      }
      damping = damping < 1e-2 ? 1e-1 : damping * 10.0;
    }
    if (!accepted || stalled) {
      // Perhaps only the kept derivatives are stale.
      const bool again = !accepted && !fresh;
      fresh = true;
      stalled = !again;
    }
  }
  // Out of iterations is a failure only where the last one still gained much.
  const bool settled = stalled || last_drop < kSettled;
  fit.status = !settled ? FitStatus::failed : bounded ? FitStatus::at_bound : FitStatus::converged;
  if (!std::isfinite(fit.deviance)) fit.status = FitStatus::failed;
  return fit;
}

}  // namespace sandhopper::diagnose
