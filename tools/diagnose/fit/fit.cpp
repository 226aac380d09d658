#include "tools/diagnose/fit/fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>

#include "tools/diagnose/fit/trial_state.hpp"
#include "tools/experiment/parallel.hpp"

namespace sandhopper::diagnose {

void evaluate(const Problem& problem, std::size_t t, const Edits& edits, TrialState& state) {
  const TrialModel& trial = *problem.trials[t];
  state.prediction = predicted(problem, trial, edits, state.nuisances);
  Eigen::VectorXd r = residual_of(trial, state.prediction);
  whiten(problem, t, r);
  state.deviance = r.squaredNorm();
  for (std::size_t i = 0; i < state.nuisances.size(); ++i)
    state.deviance += std::pow(state.nuisances[i] / trial.sd_of(i), 2);
}

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Relative drop of the deviance: a fit without iterations left is settled below this.
constexpr double kSettled = 0.01;
constexpr int kNuisanceSteps = 3;       // most steps of a trial's nuisances at each point that is tried
constexpr double kNuisanceGain = 0.03;  // predicted drop of the deviance below which the nuisances stay
constexpr double kSpeedsUp = 2.0;       // a later iteration may gain at most this many times the last gain
constexpr int kAttempts = 3;            // most damping values in one step
constexpr double kStale = 0.1;  // in standard deviations: derivatives from farther away are recomputed
constexpr double kGone = 5.0;   // drop in settle_each() below which the fit ends, in FitOptions::own_gain
constexpr int kOwnRounds = 5;   // most steps of one trial in settle_each()
// Accuracy where the deviance is far above the number of rows: share of the excess.
constexpr double kFar = 0.01;
constexpr double kHeld = 0.25;  // share of the predicted drop that an accepted step of a trial brings
// Share of the total gain of these derivatives: after a smaller step they are recomputed.
constexpr double kExhausted = 0.3;
constexpr double kWorse = 1.0;  // rise of a trial's deviance after which its old nuisances are tried, too

// Fits the nuisances of one trial alone by Levenberg-Marquardt; effects and tolerances stay.
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

// The present point of a fit, and its steps.
class Fitter {
 public:
  Fitter(const Problem& problem, const Point& start, const FitOptions& options)
      : problem_(problem),
        given_(options.columns != nullptr ? options.columns : &problem.kept_columns),
        start_(start),
        far_gain_(options.far_gain),
        own_gain_(options.own_gain) {
    at_.point = start;
    first_shared_ = shared();
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

  // One Levenberg-Marquardt step of all parameters. Returns the drop of the deviance; 0 if no damping lowers
  // it, or if the predicted drop is below `least_gain`.
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
    // Predicted drop of the deviance. The priors are quadratic, so their part is exact.
    promised = k > 0 ? score.dot(information.ldlt().solve(score)) : 0.0;
    for (std::size_t t = 0; t < linear.size(); ++t)
      promised += std::max(0.0, at_.trials[t].deviance - linear[t].gram(0, 0));
    if (promised < least_gain) return 0.0;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      MatrixXd damped = information;
      damped.diagonal() *= 1.0 + damping_;
      const VectorXd change = k > 0 ? VectorXd(damped.ldlt().solve(score)) : VectorXd();
      At next = at_;
      const bool met = move_parameters(problem_, next.point, change);
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
        // The predicted step made this trial worse: retry from its previous nuisance parameters.
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

  // Recomputes the derivatives by nuisances and tolerances at the present point.
  void refresh() {
    own_columns_ = columns_at(problem_, point());
    made_for_.assign(at_.trials.size(), {});
    for (std::size_t t = 0; t < at_.trials.size(); ++t) made_for_[t] = {at_.trials[t].nuisances, shared()};
    damping_ = 1e-3;
  }

  // Fits the nuisances of every trial separately, and recomputes its derivatives when they are stale. Returns
  // the drop of the deviance. `given_here`: the given derivatives were computed at the start.
  double settle_each(bool given_here) {
    if (own_columns_.empty()) {
      own_columns_ = *given_;
      made_for_.assign(at_.trials.size(), {});
      for (std::size_t t = 0; t < at_.trials.size() && given_here; ++t)
        made_for_[t] = {start_.nuisances[t], first_shared_};
    }
    const Edits edits = edits_for(problem_, at_.point.hypothesis, at_.point.tolerances);
    const auto here = shared();
    At next = at_;
    each_trial([&](std::size_t t) {
      TrialState& trial = next.trials[t];
      for (int round = 0; round < kOwnRounds; ++round) {
        if (is_stale(t, trial.nuisances, here)) {
          own_columns_[t] = columns_of(problem_, t, edits, trial.nuisances);
          made_for_[t] = {trial.nuisances, here};
        }
        if (!moves(t, edits, trial)) return;
      }
    });
    finish(next);
    const double drop = at_.deviance - next.deviance;
    at_ = std::move(next);
    return drop;
  }

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
  double promised = 0.0;  // predicted drop of the last step, in the linear model
  bool bounded = false;

 private:
  struct At {
    Point point;  // the nuisances in it are not used; they are in `trials`
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

  // Parameters that all trials share: effects in typical sizes, law sizes in scales of the port, tolerances
  // in their scales.
  std::vector<double> shared() const {
    std::vector<double> out;
    for (std::size_t e = 0; e < at_.point.hypothesis.candidates.size(); ++e) {
      const auto& parameters = problem_.candidates[at_.point.hypothesis.candidates[e]].parameters;
      for (std::size_t j = 0; j < parameters.size(); ++j)
        out.push_back(at_.point.hypothesis.values[e][j] / parameters[j].typical);
    }
    out.insert(out.end(), at_.point.hypothesis.law_sizes.begin(), at_.point.hypothesis.law_sizes.end());
    out.insert(out.end(), at_.point.tolerances.begin(), at_.point.tolerances.end());
    return out;
  }

  bool is_stale(std::size_t t, const std::vector<double>& nuisances,
                const std::vector<double>& shared) const {
    const auto& made = made_for_[t];
    if (made.nuisances.empty() && !nuisances.empty()) return true;
    for (std::size_t i = 0; i < shared.size(); ++i)
      if (i >= made.shared.size() || std::abs(shared[i] - made.shared[i]) > kStale) return true;
    for (std::size_t i = 0; i < nuisances.size(); ++i)
      if (std::abs(nuisances[i] - made.nuisances[i]) > kStale * problem_.trials[t]->sd_of(i)) return true;
    return false;
  }

  // One step of a trial's nuisances, shortened until it brings a quarter of the predicted drop. If no length
  // does (an event moves past a row), the full step is taken, the derivatives are recomputed there, and the
  // fit continues from there. Returns false if nothing is gained.
  bool moves(std::size_t t, const Edits& edits, TrialState& trial) {
    const auto linear = linearise(problem_, t, edits, trial.nuisances, {},
                                  {.columns = &own_columns_, .prediction = &trial.prediction});
    const double promised = trial.deviance - linear.gram(0, 0);
    const double far = trial.deviance - static_cast<double>(problem_.trials[t]->rows.size());
    const double least = std::max(own_gain_, kFar * far);
    if (promised < least) return false;
    const auto stepped = [&](double share) {
      TrialState next = trial;
      for (std::size_t i = 0; i < next.nuisances.size(); ++i)
        next.nuisances[i] += share * linear.solution(static_cast<Index>(i), 0);
      evaluate(problem_, t, edits, next);
      return next;
    };
    for (const double share : {1.0, 0.3, 0.1}) {
      TrialState next = stepped(share);
      if (trial.deviance - next.deviance < kHeld * share * (2.0 - share) * promised) continue;
      trial = std::move(next);
      return true;
    }
    TrialState next = stepped(1.0);
    std::vector<KeptColumns> there(t + 1);
    there[t] = columns_of(problem_, t, edits, next.nuisances);
    const auto made = next.nuisances;
    settle(problem_, t, edits, there, far_gain_, next);
    if (trial.deviance - next.deviance < least) return false;
    trial = std::move(next);
    own_columns_[t] = std::move(there[t]);
    made_for_[t] = {made, shared()};
    return true;
  }

  struct MadeFor {
    std::vector<double> nuisances, shared;
  };

  const Problem& problem_;
  const std::vector<KeptColumns>* given_;
  const Point& start_;
  double far_gain_, own_gain_;
  At at_;
  std::vector<KeptColumns> own_columns_;
  std::vector<MadeFor> made_for_;  // point at which each trial's derivatives were computed
  std::vector<double> first_shared_;
  double damping_ = 1e-3;
};

}  // namespace

Fit fit_from(const Problem& problem, const Point& start, const FitOptions& options) {
  Fitter fitter(problem, start, options);
  Fit fit;
  const bool far = problem.kept_columns.empty();  // no derivatives are kept yet, so `start` may be far off
  bool done = false, given_up = false;
  double last_drop = 0.0;  // relative drop of the deviance in the last step
  double gained = 0.0;     // total drop with the present derivatives
  for (fit.iterations = 0; fit.iterations < options.max_iterations && !done && !given_up; ++fit.iterations) {
    const double drop = fitter.step(0.5 * options.tolerance);
    fit.promised = std::max(0.0, fitter.promised - drop);
    if (drop > 0.0) last_drop = drop / std::max(fitter.deviance(), 1e-300);
    gained += drop;
    // A fit whose deviance stays far above its number of rows is no answer, so it may stop earlier.
    const double near_enough = kFar * (fitter.deviance() - problem.rows());
    const bool settled = drop <= std::max(options.tolerance + 1e-7 * fitter.deviance(), near_enough);
    given_up =
        !settled && fitter.deviance() - kSpeedsUp * drop * (options.max_iterations - fit.iterations - 1) >
                        options.of_use_below;
    if (far || !options.refresh) {
      done = settled;
      if (far && !done) fitter.refresh();
      continue;
    }
    if (!settled && drop > kExhausted * gained) continue;
    // These derivatives gain too little now.
    const double freed = fitter.settle_each(options.columns_made_here);
    done = settled && freed < std::max(kGone * options.own_gain, near_enough);
    gained = 0.0;
  }
  fit.point = fitter.point();
  fit.deviance = fitter.deviance();
  fit.trial_deviance = fitter.trial_deviance();
  fit.information = fitter.information;
  // Without iterations left the fit has failed only if the last one still gained 1 % of the deviance.
  const bool settled = done || (!given_up && last_drop < kSettled);
  fit.status = !settled ? FitStatus::failed : fitter.bounded ? FitStatus::at_bound : FitStatus::converged;
  if (!std::isfinite(fit.deviance)) fit.status = FitStatus::failed;
  return fit;
}

}  // namespace sandhopper::diagnose
