#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/diagnose/answer/report_parts.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// Sum of squares and number of rows per cell.
struct Squares {
  std::vector<double> sum, count;
  explicit Squares(std::size_t cells) : sum(cells, 0.0), count(cells, 0.0) {}
  double rms(std::size_t c) const { return count[c] > 0.0 ? std::sqrt(sum[c] / count[c]) : 0.0; }
};

double range_of(const Problem& problem, const std::string& channel) {
  const auto& scale = problem.context.channels.at(channel);
  return scale.high - scale.low;
}

// Sums per channel, and per channel and phase.
struct Sums {
  Squares by_channel, by_cell;
  template <class ErrorOf>
  Sums(const Problem& problem, const ErrorOf& error_of)
      : by_channel(problem.channels.size()), by_cell(problem.channels.size() * problem.phases.size()) {
    for (std::size_t t = 0; t < problem.trials.size(); ++t) {
      const auto& rows = problem.trials[t]->rows;
      for (std::size_t k = 0; k < rows.size(); ++k) {
        if (!problem.used[t][k]) continue;
        const double square = std::pow(error_of(t, k), 2);
        const std::size_t cell = rows[k].channel * problem.phases.size() + rows[k].phase;
        by_channel.sum[rows[k].channel] += square;
        ++by_channel.count[rows[k].channel];
        by_cell.sum[cell] += square;
        ++by_cell.count[cell];
      }
    }
  }
};

// Notes the trials that scatter more than the others and therefore count less.
void note_noisy_trials(const Problem& problem, Diagnosis& diagnosis) {
  for (const auto& trial : problem.trials)
    for (std::size_t c = 0; c < trial->noise_factor.size(); ++c)
      if (trial->noise_factor[c] > 1.0)
        diagnosis.notes.push_back(
            fmt::format("trial {}: {} is {:.2g} times as noisy as in the other trials and counts less there",
                        trial->name, problem.channels[c], trial->noise_factor[c]));
}

}  // namespace

// Held-out errors: the effects' parameters come from the other trials, the trial's own nuisances are fitted.
// The floor is the RMS of noise and model error in the same rows; it may differ between trials and grow with
// force.
void report_errors(const Problem& problem, const Residuals& residuals, Diagnosis& diagnosis) {
  const auto sums_of = [&](const std::vector<VectorXd>& errors) {
    return Sums(problem, [&](std::size_t t, std::size_t k) { return errors[t][static_cast<Index>(k)]; });
  };
  const Sums before = sums_of(residuals.before), after = sums_of(residuals.after),
             held_out = sums_of(residuals.held_out);
  const Sums floor(problem, [&](std::size_t t, std::size_t k) { return row_sd(problem, t, k); });
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    if (before.by_channel.count[c] == 0.0 || !problem.context.has(problem.channels[c])) continue;
    ChannelFit fit;
    fit.channel = problem.channels[c];
    fit.train = {before.by_channel.rms(c), after.by_channel.rms(c)};
    fit.heldout = {before.by_channel.rms(c), held_out.by_channel.rms(c)};
    fit.floor = floor.by_channel.rms(c);
    fit.range = range_of(problem, fit.channel);
    fit.noise = problem.noise.channel(c).sd();
    diagnosis.noise_floor[fit.channel] = fit.floor;
    diagnosis.fits.push_back(fit);
    for (std::size_t p = 0; p < problem.phases.size(); ++p) {
      const std::size_t cell = c * problem.phases.size() + p;
      if (before.by_cell.count[cell] > 0.0)
        diagnosis.phase_errors.push_back({fit.channel, problem.phases[p], before.by_cell.rms(cell),
                                          held_out.by_cell.rms(cell), floor.by_cell.rms(cell),
                                          static_cast<std::size_t>(before.by_cell.count[cell])});
    }
  }
  std::sort(diagnosis.fits.begin(), diagnosis.fits.end(), [](const ChannelFit& a, const ChannelFit& b) {
    return a.heldout.before / std::max(a.floor, 1e-300) > b.heldout.before / std::max(b.floor, 1e-300);
  });
}

void report_noise(const Problem& problem, Diagnosis& diagnosis) {
  note_noisy_trials(problem, diagnosis);
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    const auto& channel = problem.channels[c];
    if (!problem.context.has(channel)) continue;
    SensorNoise noise{.channel = channel,
                      .stated = believed_noise(problem.context.belief, channel),
                      .measured = problem.floor_sd[c],
                      .used = problem.noise.channel(c).sd()};
    for (const auto& number : diagnosis.belief)
      if (noise.stated > 0.0 && number.key == noise_key(channel)) noise.source = number.source;
    noise.is_raised = noise.used > kQuietChannel * std::max(noise.stated, noise.measured) ||
                      (noise.stated > 0.0 && noise.times() > kQuietChannel);
    noise.is_sensor_worse = noise.stated > 0.0 && noise.measured > kQuietChannel * noise.stated;
    diagnosis.noise.push_back(std::move(noise));
  }
}

}  // namespace sandhopper::diagnose
