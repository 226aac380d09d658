#include "tools/diagnose/fit/residuals.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "tools/diagnose/fit/fit.hpp"
#include "tools/diagnose/fit/linearise.hpp"
#include "tools/diagnose/fit/trial_state.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Change of a trial's rows by each effect: its amplitudes times their derivatives.
std::vector<VectorXd> changes(const Problem& problem, const Point& point, const MatrixXd& plain) {
  std::vector<VectorXd> out;
  Index column = 1;
  for (std::size_t e = 0; e < point.hypothesis.candidates.size(); ++e) {
    const auto& parameters = problem.candidates[point.hypothesis.candidates[e]].parameters;
    VectorXd sum = VectorXd::Zero(plain.rows());
    for (std::size_t j = 0; j < parameters.size(); ++j, ++column)
      if (is_amplitude(parameters, j))
        sum += plain.col(column) * (point.hypothesis.values[e][j] / parameters[j].typical);
    out.push_back(std::move(sum));
  }
  return out;
}

// Fits the nuisances of an evaluated trial by Gauss-Newton steps; the derivatives are those of each point, or
// the kept ones if a simulation is slow. A step is shortened until it lowers the deviance.
void settle_from(const Problem& problem, std::size_t t, const Edits& edits, TrialState& state) {
  constexpr int kSteps = 5;
  const bool fresh = !problem.plant->is_costly();
  for (int step = 0; step < kSteps; ++step) {
    const auto linear = linearise(problem, t, edits, state.nuisances, {},
                                  {.fresh_columns = fresh, .prediction = &state.prediction});
    const double before = state.deviance;
    for (const double share : {1.0, 0.3, 0.1}) {
      TrialState next{state.nuisances, {}};
      for (std::size_t i = 0; i < next.nuisances.size(); ++i)
        next.nuisances[i] += share * linear.solution(static_cast<Index>(i), 0);
      evaluate(problem, t, edits, next);
      if (!(next.deviance < before)) continue;
      state = std::move(next);
      break;
    }
    if (!(before - state.deviance > 0.1)) return;
  }
}

// Residual of trial `t` with the parameters moved by `step` and its own nuisances fitted, by simulations
// there. The linear model exaggerates a long step: it makes a blow that comes a little later a force. The
// nuisances begin as the linear model moves them, as they were, and at their prior means.
VectorXd left_after(const Problem& problem, std::size_t t, const Point& point, const TrialLinear& trial,
                    const VectorXd& step) {
  Point moved = point;
  move_parameters(problem, moved, step);
  const Edits edits = edits_for(problem, moved.hypothesis, moved.tolerances);
  const VectorXd follow = trial.solution.col(0) - trial.solution.rightCols(step.size()) * step;
  const auto& as_they_were = point.nuisances[t];
  auto followed = as_they_were;
  for (std::size_t i = 0; i < followed.size(); ++i) followed[i] += follow[static_cast<Index>(i)];
  std::array<TrialState, 3> starts{
      {{std::move(followed), {}}, {as_they_were, {}}, {std::vector<double>(as_they_were.size(), 0.0), {}}}};
  for (auto& start : starts) {
    evaluate(problem, t, edits, start);
    settle_from(problem, t, edits, start);
  }
  return residual_of(*problem.trials[t],
                     std::ranges::min_element(starts, {}, &TrialState::deviance)->prediction);
}

}  // namespace

double held_out_gain(const Problem& problem, const Residuals& residuals, const Point& null,
                     const Point& point) {
  double gain = 0.0;
  for (std::size_t t = 0; t < problem.trials.size(); ++t) {
    const TrialModel& trial = *problem.trials[t];
    for (std::size_t i = 0; i < trial.trial_nuisances.size(); ++i)
      if (trial.trial_nuisances[i].shift_is_evidence)
        gain += (std::pow(null.nuisances[t][i], 2) - std::pow(point.nuisances[t][i], 2)) /
                std::pow(trial.trial_nuisances[i].sd, 2);
    for (std::size_t k = 0; k < trial.rows.size(); ++k) {
      if (!problem.used[t][k]) continue;
      const auto row = static_cast<Index>(k);
      const double sd = problem.noise.sd(trial, trial.rows[k]);
      gain += (std::pow(residuals.before[t][row], 2) - std::pow(residuals.held_out[t][row], 2)) / (sd * sd);
    }
  }
  return gain;
}

Residuals residuals_of_belief(const Problem& problem, const Point& null) {
  Residuals out;
  for (auto& trial : linearise_all(problem, null, {}, {.keep_plain = true}))
    out.before.emplace_back(trial.plain.col(0));
  out.after = out.held_out = out.before;
  return out;
}

Residuals residuals_of(const Problem& problem, const Point& null, const Point& point) {
  Residuals out;
  out.before = residuals_of_belief(problem, null).before;

  const auto directions = parameter_directions(problem, point);
  const auto k = static_cast<Index>(directions.size());
  const auto linear = linearise_all(problem, point, directions, {.keep_plain = true});
  MatrixXd information = MatrixXd::Zero(k, k);
  VectorXd score = VectorXd::Zero(k);
  for (const auto& trial : linear) {
    information += trial.gram.bottomRightCorner(k, k);
    score += trial.gram.col(0).tail(k);
  }
  add_priors(problem, point, information, score);
  // A tolerance at its bound stays fixed. add_priors() has already added an information of 1.
  const auto tolerances = static_cast<Index>(point.tolerances.size());
  information.diagonal().tail(tolerances) +=
      prior_information(problem, point).tail(tolerances) - VectorXd::Ones(tolerances);
  const auto nothing = edits_for(problem, {}, point.tolerances);
  for (std::size_t t = 0; t < linear.size(); ++t) {
    const auto& trial = linear[t];
    const TrialModel& model = *problem.trials[t];
    out.found.push_back(residual_of(model, predicted(problem, model, nothing, point.nuisances[t])) -
                        trial.residual);
    const VectorXd after = trial.plain.col(0);
    VectorXd held_out = after;
    if (k > 0 && linear.size() > 1) {
      const MatrixXd others = information - trial.gram.bottomRightCorner(k, k);
      held_out = left_after(problem, t, point, trial, others.ldlt().solve(score - trial.gram.col(0).tail(k)));
    }
    out.after.push_back(after);
    out.held_out.push_back(std::move(held_out));
    out.change.push_back(changes(problem, point, trial.plain));
  }
  return out;
}

}  // namespace sandhopper::diagnose
