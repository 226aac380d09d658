#include "tools/diagnose/answer/report_parts.hpp"

namespace sandhopper::diagnose {

void report_residuals(const Problem& problem, const Residuals& residuals, Diagnosis& diagnosis) {
  for (std::size_t t = 0; t < problem.trials.size(); ++t) {
    const auto& trial = *problem.trials[t];
    for (std::size_t k = 0; k < trial.rows.size(); ++k) {
      const auto& row = trial.rows[k];
      const auto at = static_cast<Eigen::Index>(k);
      if (problem.used[t][k])
        diagnosis.residuals.push_back({trial.name, problem.channels[row.channel], problem.phases[row.phase],
                                       row.time_s, residuals.before[t][at], residuals.held_out[t][at],
                                       row_sd(problem, t, k)});
    }
  }
}

}  // namespace sandhopper::diagnose
