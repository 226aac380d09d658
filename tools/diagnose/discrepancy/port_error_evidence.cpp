#include "tools/diagnose/discrepancy/port_error_evidence.hpp"

#include "tools/diagnose/fit/fit.hpp"
#include "tools/diagnose/fit/linearise.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index, Eigen::MatrixXd;

// The belief fitted with this size of the port error: nuisances and tolerances, then the noise, then again.
Point settled(Problem& problem) {
  Point null = fit_from(problem, null_point(problem), {.max_iterations = 6}).point;
  update_noise(problem, null);
  keep_columns(problem, null);
  null = fit_from(problem, null, {.columns_made_here = true}).point;
  keep_columns(problem, null);
  take_model_error(problem, model_errors(problem, null));
  return null;
}

double log_evidence_of_trial(const Problem& problem, std::size_t t, const Point& null, const Edits& base) {
  const TrialModel& trial = *problem.trials[t];
  const auto& nuisances = null.nuisances[t];
  MatrixXd residual = residual_of(trial, predicted(problem, trial, base, nuisances));
  const auto count = static_cast<Index>(trial.trial_nuisances.size());
  const MatrixXd& error = problem.model_error[t].columns;
  MatrixXd columns(residual.rows(), count + error.cols());
  columns << problem.kept_columns[t].shared.rightCols(count), error;
  for (Index j = 0; j < count; ++j) {
    residual.col(0) += columns.col(j) * nuisances[static_cast<std::size_t>(j)];
    columns.col(j) *= trial.trial_nuisances[static_cast<std::size_t>(j)].sd;
  }
  problem.noise.whiten(trial, problem.used[t], residual);
  problem.noise.whiten(trial, problem.used[t], columns);
  const LowRank low_rank(columns);
  low_rank.whiten(residual);
  return problem.noise.log_determinant(trial, problem.used[t]) - 0.5 * low_rank.log_determinant() -
         0.5 * residual.squaredNorm();
}

}  // namespace

std::vector<double> port_error_evidence(const Recordings& recordings, std::span<const double> sizes,
                                        const std::function<void(double)>& progress) {
  std::vector<double> evidence;
  for (const double size : sizes) {
    progress(static_cast<double>(evidence.size()) / static_cast<double>(sizes.size()));
    Prepared prepared = prepare(recordings);
    Problem& problem = prepared.problem;
    problem.port_error = size;
    const Point null = settled(problem);
    const Edits base = edits_for(problem, null.hypothesis, null.tolerances);
    double sum = 0.0;
    for (std::size_t t = 0; t < problem.trials.size(); ++t)
      sum += log_evidence_of_trial(problem, t, null, base);
    evidence.push_back(sum);
  }
  return evidence;
}

}  // namespace sandhopper::diagnose
