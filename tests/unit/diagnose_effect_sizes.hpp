#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/diagnose/fit/problem.hpp"

// Effect of a candidate on a simulation, at a multiple of its typical size.
namespace sandhopper::diagnose {

inline std::vector<double> values_of(const Candidate& candidate, double typicals) {
  std::vector<double> values;
  for (std::size_t i = 0; i < candidate.parameters.size(); ++i) {
    const auto& p = candidate.parameters[i];
    const double times = is_amplitude(candidate.parameters, i) ? typicals : 1.0;
    values.push_back(std::clamp(times * p.typical, p.low, p.high));
  }
  return values;
}

inline std::vector<double> predicted(const Problem& problem, std::size_t trial, const Edits& edits) {
  const auto& model = *problem.trials[trial];
  std::vector<double> out(model.rows.size());
  model.predict(edits, std::vector<double>(model.nuisance_count(), 0.0), out);
  return out;
}

inline std::vector<double> predicted(const Problem& problem, std::size_t trial, std::size_t candidate,
                                     double typicals) {
  const Hypothesis one{{candidate}, {values_of(problem.candidates[candidate], typicals)}};
  return predicted(problem, trial, edits_for(problem, one, {}));
}

// Largest change of a row in standard deviations of its channel's noise.
inline double largest_change(const Problem& problem, std::size_t candidate, double typicals) {
  double most = 0.0;
  for (std::size_t t = 0; t < problem.trials.size(); ++t) {
    const auto plain = predicted(problem, t, Edits{});
    const auto changed = predicted(problem, t, candidate, typicals);
    for (std::size_t k = 0; k < plain.size(); ++k)
      most = std::max(most,
                      std::abs(changed[k] - plain[k]) / problem.floor_sd[problem.trials[t]->rows[k].channel]);
  }
  return most;
}

}  // namespace sandhopper::diagnose
