#include "tools/diagnose/fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>

#include "tools/diagnose/free_laws.hpp"
#include "tools/experiment/parallel.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kSettled = 0.01;
constexpr int kNuisanceSteps = 3;       // of a trial at each point that is tried
constexpr double kNuisanceGain = 0.03;  // of the deviance: less is not worth a simulation
constexpr double kSpeedsUp = 2.0;       // an iteration may gain so many times what the last one did
constexpr int kAttempts = 3;
constexpr double kWorse = 1.0;     // of a trial's deviance
constexpr double kPromise = 10.0;  // of the deviance: worth derivatives of its own
constexpr double kPriorTypicals = 10.0;
constexpr double kDerivativeStep = 0.005;  // of a parameter's typical size
constexpr double kLawStep = 0.01;          // of a free law's scale

Eigen::Map<const VectorXd> law_sizes(const Hypothesis& hypothesis) {
  return {hypothesis.law_sizes.data(), static_cast<Index>(hypothesis.law_sizes.size())};
}

double prior_deviance(const Problem& problem, const Point& point) {
  double sum = 0.0;
  if (const auto sizes = law_sizes(point.hypothesis); sizes.size() > 0)
    sum += sizes.dot(free_law_information(point.hypothesis.law.size()) * sizes);
  for (std::size_t i = 0; i < point.hypothesis.candidates.size(); ++i) {
    const auto& parameters = problem.candidates[point.hypothesis.candidates[i]].parameters;
    for (std::size_t j = 0; j < parameters.size(); ++j) {
      // Only shapes need holding: an amplitude is what is asked for.
      const bool amplitude = is_amplitude(parameters, j);
      const double centre = amplitude ? 0.0 : parameters[j].typical;
      const double sd = amplitude ? kPriorTypicals * parameters[j].typical : parameters[j].typical;
      sum += std::pow((point.hypothesis.values[i][j] - centre) / sd, 2);
    }
  }
  for (const double value : point.tolerances) sum += value * value;
  return sum;
}

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
  for (double& size : point.hypothesis.law_sizes) size += step[at++];
  for (double& value : point.tolerances)
    value = std::clamp(value + step[at++], -kMostTolerance, kMostTolerance);
  return bounded;
}

// One trial at a point: its nuisances, what they predict and how far off that is.
struct TrialState {
  std::vector<double> nuisances;
  VectorXd prediction;
  double deviance = 0.0;
};

void evaluate(const Problem& problem, std::size_t t, const Edits& edits, TrialState& state) {
  const TrialModel& trial = *problem.trials[t];
  state.prediction = predicted(problem, trial, edits, state.nuisances);
  VectorXd r = residual_of(trial, state.prediction);
  whiten(problem, t, r);
  state.deviance = r.squaredNorm();
  const std::size_t q = trial.trial_nuisances.size(), nb = trial.block_nuisances.size();
  for (std::size_t i = 0; i < state.nuisances.size(); ++i) {
    const double sd = i < q ? trial.trial_nuisances[i].sd : trial.block_nuisances[(i - q) % nb].sd;
    state.deviance += std::pow(state.nuisances[i] / sd, 2);
  }
}

// The nuisances of one trial follow by themselves (Levenberg-Marquardt): each trial at its own pace.
void settle(const Problem& problem, std::size_t t, const Edits& edits,
            const std::vector<KeptColumns>& columns, double far_gain, TrialState& state) {
  double damping = 0.0;
  for (int step = 0; step < kNuisanceSteps; ++step) {
    const auto linear = linearise(problem, t, edits, state.nuisances, {},
                                  {.columns = &columns, .prediction = &state.prediction, .damping = damping});
    const double far = state.deviance - static_cast<double>(problem.trials[t]->rows.size());
    if (state.deviance - linear.gram(0, 0) < std::max(kNuisanceGain, far_gain * far)) return;
    TrialState next = state;
    for (std::size_t i = 0; i < next.nuisances.size(); ++i)
      next.nuisances[i] += linear.solution(static_cast<Index>(i), 0);
    evaluate(problem, t, edits, next);
    if (next.deviance < state.deviance)
      state = std::move(next);
    else
      damping = damping == 0.0 ? 1.0 : 10.0 * damping;
  }
}

// Everything that a fit moves.
class Fitter {
 public:
  Fitter(const Problem& problem, const Point& start, const FitOptions& options)
      : problem_(problem),
        given_(options.columns != nullptr ? options.columns : &problem.kept_columns),
        far_gain_(options.far_gain) {
    at_.point = start;
    at_.trials.resize(problem.trials.size());
    const Edits edits = edits_for(problem, start.hypothesis, start.tolerances);
    each_trial([&](std::size_t t) {
      at_.trials[t].nuisances = start.nuisances[t];
      evaluate(problem_, t, edits, at_.trials[t]);
      if (!given_->empty()) settle(problem_, t, edits, columns(), far_gain_, at_.trials[t]);
    });
    finish(at_);
    if (given_->empty()) refresh();
  }

  // One step of all parameters; the drop of the deviance, 0 where none was found or promised.
  double step(double least_gain) {
    const auto directions = parameter_directions(problem_, at_.point);
    const Edits edits = edits_for(problem_, at_.point.hypothesis, at_.point.tolerances);
    std::vector<TrialLinear> linear(at_.trials.size());
    each_trial([&](std::size_t t) {
      linear[t] = linearise(problem_, t, edits, at_.trials[t].nuisances, directions,
                            {.columns = &columns(), .prediction = &at_.trials[t].prediction});
    });
    const auto k = static_cast<Index>(directions.size());
    information = MatrixXd::Zero(k, k);
    VectorXd score = VectorXd::Zero(k);
    for (const auto& trial : linear) {
      information += trial.gram.bottomRightCorner(k, k);
      score += trial.gram.col(0).tail(k);
    }
    add_priors(problem_, at_.point, information, score);
    // What the step promises; priors are quadratic and exact.
    promised = k > 0 ? score.dot(information.ldlt().solve(score)) : 0.0;
    for (std::size_t t = 0; t < linear.size(); ++t)
      promised += std::max(0.0, at_.trials[t].deviance - linear[t].gram(0, 0));
    if (promised < least_gain) return 0.0;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      MatrixXd damped = information;
      damped.diagonal() *= 1.0 + damping_;
      const VectorXd change = k > 0 ? VectorXd(damped.ldlt().solve(score)) : VectorXd();
      At next = at_;
      const bool met = move(problem_, next.point, change);
      const Edits moved = edits_for(problem_, next.point.hypothesis, next.point.tolerances);
      each_trial([&](std::size_t t) {
        TrialState& trial = next.trials[t];
        VectorXd follow = linear[t].solution.col(0);
        if (k > 0) follow -= linear[t].solution.rightCols(k) * change;
        for (std::size_t i = 0; i < trial.nuisances.size(); ++i)
          trial.nuisances[i] += follow[static_cast<Index>(i)];
        evaluate(problem_, t, moved, trial);
        settle(problem_, t, moved, columns(), far_gain_, trial);
        if (trial.deviance < at_.trials[t].deviance + kWorse) return;
        // This one was led astray: from where it was.
        TrialState other{at_.trials[t].nuisances, {}, 0.0};
        evaluate(problem_, t, moved, other);
        settle(problem_, t, moved, columns(), far_gain_, other);
        if (other.deviance < trial.deviance) trial = std::move(other);
      });
      finish(next);
      const double drop = at_.deviance - next.deviance;
      if (drop > 0.0) {
        at_ = std::move(next);
        bounded = met;
        damping_ = std::max(0.2 * damping_, 1e-6);
        return drop;
      }
      damping_ = damping_ < 1e-2 ? 1e-1 : damping_ * 10.0;
    }
    return 0.0;
  }

  // Derivatives by nuisances and tolerances as they are here.
  void refresh() {
    own_columns_ = columns_at(problem_, point());
    damping_ = 1e-3;
  }
  bool refreshed() const { return !own_columns_.empty(); }

  Point point() const {
    Point point = at_.point;
    for (std::size_t t = 0; t < at_.trials.size(); ++t) point.nuisances[t] = at_.trials[t].nuisances;
    return point;
  }
  double deviance() const { return at_.deviance; }
  std::vector<double> trial_deviance() const {
    std::vector<double> out;
    for (const auto& trial : at_.trials) out.push_back(trial.deviance);
    return out;
  }

  MatrixXd information;
  double promised = 0.0;  // drop of the last step, had everything been linear
  bool bounded = false;

 private:
  struct At {
    Point point;  // but for the nuisances
    std::vector<TrialState> trials;
    double deviance = 0.0;
  };

  void each_trial(const std::function<void(std::size_t)>& work) const {
    parallel_for(problem_.trials.size(), work);
  }
  const std::vector<KeptColumns>& columns() const { return own_columns_.empty() ? *given_ : own_columns_; }
  void finish(At& at) const {
    at.deviance = prior_deviance(problem_, at.point);
    for (const auto& trial : at.trials) at.deviance += trial.deviance;
  }

  const Problem& problem_;
  const std::vector<KeptColumns>* given_;
  double far_gain_;
  At at_;
  std::vector<KeptColumns> own_columns_;
  double damping_ = 1e-3;
};

}  // namespace

void add_priors(const Problem& problem, const Point& point, MatrixXd& information, VectorXd& score) {
  Index at = 0;
  for (std::size_t i = 0; i < point.hypothesis.candidates.size(); ++i) {
    const auto& parameters = problem.candidates[point.hypothesis.candidates[i]].parameters;
    for (std::size_t j = 0; j < parameters.size(); ++j, ++at) {
      const bool amplitude = is_amplitude(parameters, j);
      const double centre = amplitude ? 0.0 : parameters[j].typical;
      const double weight = amplitude ? 1.0 / (kPriorTypicals * kPriorTypicals) : 1.0;
      information(at, at) += weight;
      score[at] -= weight * (point.hypothesis.values[i][j] - centre) / parameters[j].typical;
    }
  }
  if (const auto sizes = law_sizes(point.hypothesis); sizes.size() > 0) {
    const MatrixXd of_law = free_law_information(point.hypothesis.law.size());
    information.block(at, at, sizes.size(), sizes.size()) += of_law;
    score.segment(at, sizes.size()) -= of_law * sizes;
    at += sizes.size();
  }
  for (const double value : point.tolerances) {
    information(at, at) += 1.0;
    score[at++] -= value;
  }
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
  for (std::size_t k = 0; k < point.hypothesis.law.size(); ++k) {
    Hypothesis moved = point.hypothesis;
    moved.law_sizes[k] += kLawStep;
    directions.push_back({edits_for(problem, moved, point.tolerances), kLawStep});
  }
  for (std::size_t i = 0; i < point.tolerances.size(); ++i) {
    directions.push_back({{}, 1.0, static_cast<int>(i)});
  }
  return directions;
}

VectorXd prior_information(const Problem& problem, const Point& point) {
  constexpr double kHeld = 1e12;
  const auto own = static_cast<Index>(point.hypothesis.parameters());
  const auto tolerances = static_cast<Index>(problem.tolerances.size());
  VectorXd prior = VectorXd::Constant(own + tolerances, 1.0 / (kPriorTypicals * kPriorTypicals));
  for (Index i = 0; i < tolerances; ++i)
    prior[own + i] = std::abs(point.tolerances[static_cast<std::size_t>(i)]) < kMostTolerance ? 1.0 : kHeld;
  return prior;
}

Fit fit_from(const Problem& problem, const Point& start, const FitOptions& options) {
  Fitter fitter(problem, start, options);
  Fit fit;
  const bool far = problem.kept_columns.empty();  // from where anything was known
  const auto may_refresh = [&] { return options.refresh && !far && !fitter.refreshed(); };
  bool done = false, given_up = false;
  double last_drop = 0.0;  // of the deviance, relative
  for (fit.iterations = 0; fit.iterations < options.max_iterations && !done && !given_up; ++fit.iterations) {
    const double drop = fitter.step(0.5 * options.tolerance);
    fit.promised = std::max(0.0, fitter.promised - drop);
    if (drop > 0.0) last_drop = drop / std::max(fitter.deviance(), 1e-300);
    if (drop > options.tolerance + 1e-7 * fitter.deviance()) {
      const bool short_of = fitter.promised > kPromise && drop < 0.5 * fitter.promised;
      if (far || (short_of && may_refresh())) fitter.refresh();
      given_up = fitter.deviance() - kSpeedsUp * drop * (options.max_iterations - fit.iterations - 1) >
                 options.of_use_below;
      continue;
    }
    // Perhaps only the kept derivatives are stale.
    done = !may_refresh();
    if (!done) fitter.refresh();
  }
  fit.point = fitter.point();
  fit.deviance = fitter.deviance();
  fit.trial_deviance = fitter.trial_deviance();
  fit.information = fitter.information;
  // Out of iterations is a failure only where the last one still gained much.
  const bool settled = done || (!given_up && last_drop < kSettled);
  fit.status = !settled ? FitStatus::failed : fitter.bounded ? FitStatus::at_bound : FitStatus::converged;
  if (!std::isfinite(fit.deviance)) fit.status = FitStatus::failed;
  return fit;
}

}  // namespace sandhopper::diagnose
