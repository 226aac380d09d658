#include "tools/diagnose/discrepancy/overlap.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "tools/diagnose/fit/linearise.hpp"
#include "tools/experiment/parallel.hpp"

namespace sandhopper::diagnose {

using Eigen::VectorXd, Eigen::Index;

double shown_by_others(const Problem& problem, const Point& point, std::size_t e) {
  constexpr double kShows = 0.1;  // share of its largest change from which the effect acts in a row
  Hypothesis others = point.hypothesis;
  others.candidates.erase(others.candidates.begin() + static_cast<std::ptrdiff_t>(e));
  others.values.erase(others.values.begin() + static_cast<std::ptrdiff_t>(e));
  const Edits with = edits_for(problem, point.hypothesis, point.tolerances);
  const Edits without = edits_for(problem, others, point.tolerances);
  const Edits nothing = edits_for(problem, {}, point.tolerances);
  std::vector<double> of_trial(problem.trials.size(), 0.0);
  parallel_for(of_trial.size(), [&](std::size_t t) {
    const TrialModel& trial = *problem.trials[t];
    const VectorXd beside = predicted(problem, trial, without, point.nuisances[t]);
    VectorXd own = predicted(problem, trial, with, point.nuisances[t]) - beside;
    VectorXd theirs = beside - predicted(problem, trial, nothing, point.nuisances[t]);
    for (Index k = 0; k < own.size(); ++k) {
      const double sd = problem.noise.sd(trial, trial.rows[static_cast<std::size_t>(k)]);
      own[k] /= sd;
      theirs[k] /= sd;
    }
    const double least = kShows * own.cwiseAbs().maxCoeff();
    for (Index k = 0; k < own.size(); ++k)
      if (problem.used[t][static_cast<std::size_t>(k)] && std::abs(own[k]) > least)
        of_trial[t] += std::min(theirs[k] * theirs[k], kFormUnnoticedPerRow);
  });
  return std::accumulate(of_trial.begin(), of_trial.end(), 0.0);
}

}  // namespace sandhopper::diagnose
