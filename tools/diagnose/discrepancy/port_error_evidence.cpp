#include "tools/diagnose/discrepancy/port_error_evidence.hpp"

#include "tools/diagnose/fit/fit.hpp"
#include "tools/diagnose/fit/linearise.hpp"
#include "tools/diagnose/recordings/data_faults.hpp"

namespace sandhopper::diagnose {
namespace {

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

// ln of the density of a trial's rows, with its nuisances and its model error integrated out.
double log_evidence_of_trial(const Problem& problem, std::size_t t, const Point& null, const Edits& base) {
  const TrialLinear linear = linearise(problem, t, base, null.nuisances[t], {});
  const double of_errors =
      problem.model_error.empty() ? 0.0 : problem.model_error[t].low_rank.log_determinant();
  return problem.noise.log_determinant(*problem.trials[t], problem.used[t]) -
         0.5 * (of_errors + linear.log_determinant + linear.gram(0, 0));
}

}  // namespace

std::vector<double> port_error_evidence(const Recordings& recordings, std::span<const double> sizes,
                                        const std::function<void(double)>& progress) {
  Recordings clean = recordings;
  remove_data_faults(clean.trials);
  std::vector<double> evidence;
  for (const double size : sizes) {
    progress(static_cast<double>(evidence.size()) / static_cast<double>(sizes.size()));
    Prepared prepared = prepare(clean);
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
