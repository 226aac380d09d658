#include "tools/diagnose/fit/prepare.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "tools/diagnose/discrepancy/free_laws.hpp"
#include "tools/diagnose/discrepancy/left_over.hpp"
#include "tools/diagnose/fit/fit.hpp"
#include "tools/diagnose/fit/linearise.hpp"
#include "tools/diagnose/fit/signatures.hpp"
#include "tools/diagnose/fit/statistics.hpp"
#include "tools/diagnose/plants/inputs.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Uncertainty of a sampling instant, as a share of the sample period.
constexpr double kClockTolerance = 0.15;
// Upper limit of that, as a share of the row period: a slow sensor's sample is written to the next row.
constexpr double kRowTolerance = 0.5;
// Share of PlantModel::unsure_age_s that is one standard deviation: 1 / sqrt(12), any age being equally
// likely.
constexpr double kAgeTolerance = 0.29;
// Share of a conversion time: a mean over it is half a conversion old.
constexpr double kConversionTolerance = 0.29;
constexpr double kPreparedOutlier = 8.0;      // in standard deviations: a larger lone residual is an outlier
constexpr std::size_t kRowsPerFreeTerm = 10;  // with fewer, the noise is estimated without free laws

// Smallest change between successive samples: the converter's resolution.
double least_step(const std::vector<Trial>& trials, const std::string& channel) {
  double least = 1e300;
  for (const auto& trial : trials) {
    const auto s = samples_of(trial, channel);
    for (std::size_t i = 1; i < s.value.size(); ++i)
      if (s.value[i] != s.value[i - 1]) least = std::min(least, std::abs(s.value[i] - s.value[i - 1]));
  }
  return least < 1e299 ? least : 0.0;
}

ChannelScale scale_of(const std::vector<Trial>& trials, const std::string& channel) {
  ChannelScale scale{.low = 1e300, .high = -1e300};
  std::vector<double> noises, steps;
  double samples = 0.0;
  for (const auto& trial : trials) {
    const auto s = samples_of(trial, channel);
    if (s.value.size() < 5) continue;
    noises.push_back(fluctuation_rms(without_repeats(s)));
    steps.push_back(median_step_s(s.time_s));
    samples += static_cast<double>(s.value.size());
    for (const double v : s.value) {
      scale.low = std::min(scale.low, v);
      scale.high = std::max(scale.high, v);
    }
  }
  if (samples == 0.0) return scale;
  scale.noise_rms = median(noises);
  const double near_end = std::max(std::abs(scale.low), std::abs(scale.high)) - kNoiseBand * scale.noise_rms;
  for (const auto& trial : trials)
    for (const double v : samples_of(trial, channel).value) {
      scale.share_near_end += std::abs(v) >= near_end ? 1.0 / samples : 0.0;
      scale.share_at_high += v == scale.high ? 1.0 / samples : 0.0;
      scale.share_at_low += v == scale.low ? 1.0 / samples : 0.0;
    }
  scale.step_s = median(steps);
  scale.grid = least_step(trials, channel);
  return scale;
}

// The belief with each number's median over the trials, set-ups included. Effects take their typical sizes
// from it.
Belief believed_of_trials(const Recordings& recordings) {
  Belief typical = recordings.belief;
  std::map<std::string, std::vector<double>> values;
  for (const auto& belief : recordings.beliefs)
    for (const auto& [key, value] : belief.numbers) values[key].push_back(value);
  for (auto& [key, of_trials] : values)
    if (of_trials.size() == recordings.beliefs.size()) typical.numbers[key] = median(std::move(of_trials));
  return typical;
}

bool can_be_simulated(const TrialModel& trial) {
  const std::vector<double> nothing(trial.nuisance_count(), 0.0);
  std::vector<double> out(trial.rows.size());
  trial.predict({}, nothing, out);
  return std::all_of(out.begin(), out.end(), [](double v) { return std::isfinite(v); });
}

void mark_outliers(Problem& problem, const std::vector<VectorXd>& residuals) {
  for (std::size_t t = 0; t < problem.trials.size(); ++t) {
    const auto& rows = problem.trials[t]->rows;
    for (std::size_t k = 1; k + 1 < rows.size(); ++k) {
      const auto at = static_cast<Index>(k);
      const double sd =
          rows[k].relative_sd * problem.noise.channel(rows[k].channel).sd_of_phase[rows[k].phase];
      const auto far = [&](Index i) { return std::abs(residuals[t][i]) > kPreparedOutlier * sd; };
      // An outlier is a single row. A mismatch of the model spans several rows.
      const bool alone = far(at) && std::abs(residuals[t][at - 1]) < 0.3 * std::abs(residuals[t][at]) &&
                         std::abs(residuals[t][at + 1]) < 0.3 * std::abs(residuals[t][at]);
      if (alone) problem.used[t][k] = 0;
    }
  }
}

// Finds trials that are much noisier than the others, e.g. because something rattles, and stores their
// factor. They then neither raise the noise of the others nor count as much. `residuals` are divided by the
// factor.
void find_noisy_trials(Problem& problem, std::vector<VectorXd>& residuals) {
  constexpr double kNoisy = 2.0;  // ratio to the median trial from which a trial has its own noise
  const std::size_t channels = problem.channels.size();
  for (auto& trial : problem.trials) trial->noise_factor.assign(channels, 1.0);
  for (std::size_t c = 0; c < channels; ++c) {
    std::vector<double> level(problem.trials.size(), 0.0), recorded;
    for (std::size_t t = 0; t < problem.trials.size(); ++t) {
      std::vector<double> sizes;
      const auto& rows = problem.trials[t]->rows;
      for (std::size_t k = 0; k < rows.size(); ++k)
        if (rows[k].channel == c && problem.used[t][k])
          sizes.push_back(std::abs(residuals[t][static_cast<Index>(k)]) / rows[k].relative_sd);
      if (sizes.size() < 30) continue;
      recorded.push_back(level[t] = std::max(median(std::move(sizes)), 0.5 * problem.floor_sd[c]));
    }
    if (recorded.size() < 3) continue;
    const double usual = median(recorded);
    for (std::size_t t = 0; t < problem.trials.size(); ++t)
      if (level[t] > kNoisy * usual) problem.trials[t]->noise_factor[c] = level[t] / usual;
  }
  for (std::size_t t = 0; t < problem.trials.size(); ++t)
    for (std::size_t k = 0; k < problem.trials[t]->rows.size(); ++k)
      residuals[t][static_cast<Index>(k)] /=
          problem.trials[t]->noise_factor[problem.trials[t]->rows[k].channel];
}

// Trials that can be simulated; the others are named in `left_out`.
void take_trials(const Recordings& recordings, Prepared& prepared) {
  Problem& problem = prepared.problem;
  for (std::size_t i = 0; i < recordings.trials.size(); ++i) {
    std::string why;
    auto model = problem.plant->trial(recordings.trials[i], recordings.beliefs[i], why);
    if (!model) {
      prepared.left_out.push_back(recordings.trials[i].name + ": " + why);
      continue;
    }
    model->add_key_spreads(recordings.beliefs[i]);
    if (!can_be_simulated(*model)) {
      prepared.left_out.push_back(recordings.trials[i].name +
                                  ": what is believed cannot be simulated there (a mass of zero?)");
      continue;
    }
    problem.used.emplace_back(model->rows.size(), std::uint8_t{1});
    problem.trials.push_back(std::move(model));
  }
}

// Scale and least noise of each channel; those that never change are named in `missing_channels`.
void take_channels(const Recordings& recordings, Prepared& prepared) {
  Problem& problem = prepared.problem;
  for (const auto& channel : problem.channels) {
    if (const double sd = problem.plant->least_sd(channel); sd > 0.0) {
      problem.floor_sd.push_back(sd);
      continue;
    }
    const ChannelScale scale = scale_of(recordings.trials, channel);
    const double span = std::max(scale.high - scale.low, 0.0);
    const double floor = std::max({scale.noise_rms, 0.5 * scale.grid / std::sqrt(12.0), 1e-6 * span, 1e-12});
    problem.floor_sd.push_back(floor);
    if (span > 0.0)
      problem.context.channels[channel] = scale;
    else
      prepared.missing_channels.push_back(channel);
  }
}

// Facts that no recording states and all trials share: times of samples, means over a row, numbers that the
// belief leaves open.
std::vector<Tolerance> tolerances_of(const Problem& problem) {
  std::vector<Tolerance> tolerances;
  const double row_s = problem.row_s;
  for (const auto& [channel, scale] : problem.context.channels) {
    const double sampling_s = std::min(kClockTolerance * scale.step_s, kRowTolerance * row_s);
    const double age_s = kAgeTolerance * problem.plant->unsure_age_s(channel, problem.context.belief, row_s);
    const double mean_s = kConversionTolerance * conversion_s(problem.context.belief, channel);
    tolerances.push_back({"time of " + channel, std::hypot(sampling_s, age_s, mean_s), channel, sampling_s});
    // It is also unknown if a value is the one at an instant, or the mean over the row or over the
    // conversion.
    if (problem.plant->changes_within_rows())
      tolerances.push_back({"mean of " + channel, 1.0, channel, 0.0, "",
                            std::hypot(row_s, conversion_s(problem.context.belief, channel))});
  }
  if (const double unsure_s = problem.plant->drive_unsure_s(); unsure_s > 0.0)
    tolerances.push_back({"time of the drive", unsure_s, "actuator", 0.0});
  for (const auto& key : problem.plant->unsure_keys())
    tolerances.push_back({key.name, key.most / kMostTolerance, "", 0.0, key.belief_key});
  for (const auto& known : problem.context.belief.known_to) {
    const double size = std::abs(problem.context.belief.value(known.key));
    if (known.sd == 0.0 || (known.is_relative && size == 0.0)) continue;
    if (const auto key = simulated_key(known.key); key != known.key)
      tolerances.push_back(
          {known.name, known.is_relative ? known.sd : known.sd / size, "", 0.0, key, 0.0, true, true});
    else
      tolerances.push_back({known.name, known.sd, "", 0.0, known.key, 0.0, known.is_relative, true});
  }
  return tolerances;
}

}  // namespace

void update_noise(Problem& problem, const Point& point) {
  take_model_error(problem, model_errors(problem, point));
  const Signatures signatures = signatures_at(problem, point);
  const auto directions = parameter_directions(problem, point);
  const auto own = static_cast<Index>(directions.size());
  const double rows = problem.rows();
  const auto ports = problem.plant->free_ports(problem.context);
  const auto takes_up_noise = [&](const FreeFamily& family) {
    return std::ranges::any_of(
        ports, [&](const FreePort& port) { return port.takes_up_noise && port.port == family.port; });
  };
  std::vector<Index> taken;
  for (std::size_t i = 0; i < signatures.alternatives.size(); ++i)
    if (i == 0 || signatures.alternatives[i].candidate != signatures.alternatives[i - 1].candidate)
      taken.push_back(signatures.alternatives[i].first);
  double terms = 0.0;
  for (const auto& law : signatures.laws)
    if (!takes_up_noise(law.family)) terms += static_cast<double>(law.family.terms.size());
  // In a short recording so many columns would fit the noise.
  if (rows > kRowsPerFreeTerm * terms)
    for (const auto& law : signatures.laws)
      for (Index i = 0; i < static_cast<Index>(law.family.terms.size()) && !takes_up_noise(law.family); ++i)
        taken.push_back(law.first + i);
  std::vector<MatrixXd> more;
  for (const auto& columns : signatures.columns) more.emplace_back(columns(Eigen::all, taken));

  const auto linear = linearise_all(problem, point, directions, {.more = &more, .keep_plain = true});
  const Index k = own + static_cast<Index>(taken.size());
  MatrixXd information = MatrixXd::Zero(k, k);
  VectorXd score = VectorXd::Zero(k);
  for (const auto& trial : linear) {
    information += trial.gram.bottomRightCorner(k, k);
    score += trial.gram.col(0).tail(k);
  }
  MatrixXd held = information;
  for (Index i = 0; i < k; ++i) held(i, i) += i < own ? kPriorOfAmplitude : 0.04;
  const auto solver = held.ldlt();
  const VectorXd size = solver.solve(score);
  double taken_up = solver.solve(information).trace();
  for (const auto& trial : problem.trials) taken_up += static_cast<double>(trial->nuisance_count());
  std::vector<VectorXd> residuals;
  residuals.reserve(linear.size());
  for (const auto& trial : linear) residuals.push_back(trial.plain.col(0) - trial.plain.rightCols(k) * size);
  for (std::size_t t = 0; t < problem.model_error.size(); ++t) {
    const ModelError& error = problem.model_error[t];
    VectorXd white = residuals[t];
    problem.noise.whiten(*problem.trials[t], problem.used[t], white);
    residuals[t] -= error.columns * error.low_rank.amplitudes(error.white, white);
    taken_up += error.low_rank.taken_up();
  }
  find_noisy_trials(problem, residuals);
  NoiseModel noise = estimate_noise(problem.trial_pointers(), problem.used, residuals, problem.phases.size(),
                                    problem.floor_sd);
  noise.widen(std::sqrt(rows / std::max(0.25 * rows, rows - taken_up)));
  // A condition (PlantModel::least_sd) keeps its own standard deviation, whatever the residuals are.
  for (std::size_t c = 0; c < problem.channels.size(); ++c)
    if (const double sd = problem.plant->least_sd(problem.channels[c]); sd > 0.0) noise.fix(c, sd);
  take_noise(problem, std::move(noise));
  mark_outliers(problem, residuals);
}

Prepared prepare(const Recordings& recordings, std::size_t stretch) {
  Prepared prepared;
  Problem& problem = prepared.problem;
  problem.plant = make_plant(recordings.plant);
  problem.plant->simulate_in_stretches(problem.plant->stretches(recordings.trials).at(stretch));
  problem.port_error = problem.plant->port_error();
  problem.channels = problem.plant->channels();
  problem.phases = problem.plant->phases();
  problem.context.plant = recordings.plant;
  problem.context.belief = believed_of_trials(recordings);
  double smallest_m = 1e300, largest_m = 0.0;
  for (const auto& belief : recordings.beliefs) {
    smallest_m = std::min(smallest_m, belief.value("foot.radius_m"));
    largest_m = std::max(largest_m, belief.value("foot.radius_m"));
  }
  problem.context.facts.foot_radius_ratio = smallest_m > 0.0 ? largest_m / smallest_m : 1.0;
  take_trials(recordings, prepared);
  take_channels(recordings, prepared);
  problem.plant->describe(recordings.trials, problem.context);
  problem.effects = known_effects();
  problem.candidates = candidates_for(problem.effects, problem.context);
  for (const auto& label : put_in_place(problem))
    prepared.left_out.push_back(label + " of [effects]: no effect of that name can be in this campaign");
  std::vector<double> row_steps;
  for (const auto& trial : recordings.trials) row_steps.push_back(median_step_s(trial.time_s));
  problem.row_s = median(row_steps);
  problem.tolerances = tolerances_of(problem);
  std::vector<double> first_sd = problem.floor_sd;
  for (std::size_t c = 0; c < first_sd.size(); ++c)
    first_sd[c] = std::max(first_sd[c], believed_noise(recordings.belief, problem.channels[c]));
  take_noise(problem, white_noise(first_sd, problem.phases.size()));
  return prepared;
}

}  // namespace sandhopper::diagnose
