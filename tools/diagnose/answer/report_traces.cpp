#include <algorithm>
#include <cmath>

#include "tools/diagnose/answer/report_parts.hpp"
#include "tools/diagnose/model/quantity.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index;

constexpr std::size_t kMostTrials = 3;
constexpr std::size_t kMostTracePoints = 500;  // per channel and trial

// Mean square of the residual / noise.
double excess(const Problem& problem, std::size_t trial, const Eigen::VectorXd& residual) {
  double sum = 0.0, count = 0.0;
  const auto& rows = problem.trials[trial]->rows;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (!problem.used[trial][k]) continue;
    const double sd = problem.noise.channel(rows[k].channel).sd_of_phase[rows[k].phase];
    sum += std::pow(residual[static_cast<Index>(k)] / sd, 2);
    ++count;
  }
  return count > 0.0 ? sum / count : 0.0;
}

// The trials with the largest, smallest and median residual.
std::vector<std::size_t> shown_trials(const Problem& problem, const Residuals& residuals) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t t = 0; t < residuals.before.size(); ++t)
    order.emplace_back(-excess(problem, t, residuals.before[t]), t);
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> shown;
  const std::size_t n = order.size(), many = std::min(n, kMostTrials);
  for (std::size_t i = 0; i < many; ++i)
    shown.push_back(order[many > 1 ? i * (n - 1) / (many - 1) : 0].second);
  return shown;
}

}  // namespace

void report_traces(const Problem& problem, const Recordings& recordings, const Residuals& residuals,
                   Diagnosis& diagnosis) {
  for (const std::size_t t : shown_trials(problem, residuals)) {
    const TrialModel& model = *problem.trials[t];
    std::string setup;
    for (const auto& trial : recordings.trials)
      if (trial.name == model.name) setup = trial_in_words(trial.kind, {}, trial.setup);
    for (std::uint32_t c = 0; c < problem.channels.size(); ++c) {
      if (!problem.context.has(problem.channels[c])) continue;
      std::vector<std::size_t> rows;
      for (std::size_t k = 0; k < model.rows.size(); ++k)
        if (model.rows[k].channel == c && problem.used[t][k]) rows.push_back(k);
      if (rows.empty()) continue;
      Trace trace{model.name, setup, problem.channels[c], {}, {}, {}, {}, {}};
      const std::size_t step = (rows.size() + kMostTracePoints - 1) / kMostTracePoints;
      for (std::size_t i = 0; i < rows.size(); i += step) {
        const Row& row = model.rows[rows[i]];
        const auto k = static_cast<Index>(rows[i]);
        trace.time_s.push_back(row.time_s);
        trace.measured.push_back(row.measured);
        trace.before.push_back(row.measured - residuals.before[t][k]);
        trace.after.push_back(row.measured - residuals.held_out[t][k]);
        trace.floor.push_back(row_sd(problem, t, rows[i]));
      }
      diagnosis.traces.push_back(std::move(trace));
    }
  }
}

}  // namespace sandhopper::diagnose
