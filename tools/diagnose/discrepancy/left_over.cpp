#include "tools/diagnose/discrepancy/left_over.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "tools/diagnose/discrepancy/misfit.hpp"
#include "tools/diagnose/fit/linearise.hpp"
#include "tools/diagnose/fit/statistics.hpp"

namespace sandhopper::diagnose {
namespace {

// Largest number of trials counted in z.
constexpr double kMostTrials = 12.0;

}  // namespace

std::string noise_key(const std::string& channel) {
  static const std::map<std::string, std::string> kKeys{{"height_m", "height_noise_m"},
                                                        {"accel_mps2", "accel_noise_mps2"},
                                                        {"position_rad", "position_noise_rad"},
                                                        {"velocity_radps", "velocity_noise_radps"},
                                                        {"force_N", "load_cell_noise_N"},
                                                        {"motor_left_position_rad", "encoder_noise_rad"},
                                                        {"motor_right_position_rad", "encoder_noise_rad"},
                                                        {"imu_body_accel_z_mps2", "imu_noise_mps2"},
                                                        {"imu_foot_accel_z_mps2", "imu_noise_mps2"},
                                                        {"load_cell_force_N", "load_cell_noise_N"}};
  const auto it = kKeys.find(channel);
  return it == kKeys.end() ? "" : "sensors." + it->second;
}

double believed_noise(const Belief& belief, const std::string& channel) {
  const auto key = noise_key(channel);
  return key.empty() ? 0.0 : belief.value(key);
}

double noise_over_sensors(const Problem& problem) {
  double sum = 0.0, count = 0.0;
  for (std::size_t c = 0; c < problem.channels.size(); ++c)
    if (problem.context.channels.contains(problem.channels[c])) {
      sum += std::log(problem.noise.channel(c).sd() / problem.floor_sd[c]);
      ++count;
    }
  return count > 0.0 ? std::exp(sum / count) : 1.0;
}

namespace {

// Per channel with a stated noise: residual RMS / noise RMS, median over the trials; 0 with too few trials.
std::vector<double> residual_over_noise(const Problem& problem, const Fit& fit) {
  const Edits edits = edits_for(problem, fit.point.hypothesis, fit.point.tolerances);
  std::vector<std::vector<double>> ratios(problem.channels.size());
  for (std::size_t t = 0; t < problem.trials.size(); ++t) {
    const TrialModel& trial = *problem.trials[t];
    const auto residual = residual_of(trial, predicted(problem, trial, edits, fit.point.nuisances[t]));
    std::vector<double> left(ratios.size(), 0.0), noise(ratios.size(), 0.0);
    for (std::size_t k = 0; k < trial.rows.size(); ++k) {
      if (!problem.used[t][k]) continue;
      const Row& row = trial.rows[k];
      left[row.channel] += std::pow(residual[static_cast<Eigen::Index>(k)], 2);
      noise[row.channel] += std::pow(row_sd(problem, t, k), 2);
    }
    for (std::size_t c = 0; c < ratios.size(); ++c)
      if (noise[c] > 0.0 && believed_noise(problem.context.belief, problem.channels[c]) > 0.0)
        ratios[c].push_back(std::sqrt(left[c] / noise[c]));
  }
  std::vector<double> of_channel;
  for (const auto& of_trials : ratios)
    of_channel.push_back(of_trials.size() >= kTooFewTrials ? median(of_trials) : 0.0);
  return of_channel;
}

}  // namespace

double LeftOver::share() const {
  if (after <= 1.0) return 0.0;
  return before > after ? (after * after - 1.0) / (before * before - 1.0) : 1.0;
}

LeftOver left_over_noise(const Problem& problem, const Fit& without, const Fit& with) {
  const auto before = residual_over_noise(problem, without), after = residual_over_noise(problem, with);
  const auto most = std::ranges::max_element(after) - after.begin();
  return after.empty() ? LeftOver{} : LeftOver{before[most], after[most]};
}

std::optional<NoisyChannel> noisiest_channel(const Problem& problem) {
  // `kNoisy`: ratio above which a channel is reported.
  // `kSmooth`: innovation / total standard deviation of an acceleration that changes slowly.
  constexpr double kNoisy = 4.5, kSmooth = 0.6;
  std::optional<NoisyChannel> noisiest;
  std::size_t noisy_index = 0;
  std::vector<double> times(problem.channels.size(), 0.0), own(problem.channels.size(), 0.0);
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    const auto& channel = problem.channels[c];
    const double believed = believed_noise(problem.context.belief, channel);
    if (believed <= 0.0 || !problem.context.channels.contains(channel)) continue;
    own[c] = std::max(believed, problem.floor_sd[c]);
    times[c] = problem.noise.channel(c).sd() / own[c];
    if (times[c] > (noisiest ? noisiest->times : kNoisy)) {
      noisiest = NoisyChannel{channel, times[c], channel};
      noisy_index = c;
    }
  }
  if (!noisiest) return std::nullopt;
  const auto& by_phase = problem.noise.channel(noisy_index).sd_of_phase;
  const auto quiet_phase = problem.plant->quiet_phase();
  // The sensor alone is noisy if it is noisy in a phase without forces, or if the other channels show
  // nothing.
  bool sensor_alone = quiet_phase && by_phase[*quiet_phase] > kNoisy * own[noisy_index];
  // A real acceleration changes slowly from sample to sample; a sensor's noise does not. Heights hardly show
  // a short disturbance, so they cannot rule out a force.
  const auto is_smooth = [&] {
    const auto& of_phase = problem.noise.channel(noisy_index).correlation_of_phase;
    return std::ranges::all_of(of_phase, [](const Autoregression& a) { return a.innovation_sd < kSmooth; });
  };
  const bool accelerates = noisiest->channel.find("accel") != std::string::npos && is_smooth();
  if (!quiet_phase && !accelerates) {
    times.erase(times.begin() + static_cast<std::ptrdiff_t>(noisy_index));
    std::erase(times, 0.0);  // Drop channels without a stated noise.
    sensor_alone = !times.empty() && std::ranges::all_of(times, [](double t) { return t < kQuietChannel; });
  }
  const auto ports = problem.plant->free_ports(problem.context);
  if (!sensor_alone && !ports.empty())
    noisiest->port = ports.front().port.substr(0, ports.front().port.find('.'));
  return noisiest;
}

std::vector<CommonShift> common_shifts(const Problem& problem, const Point& point) {
  std::vector<CommonShift> shifts;
  if (problem.trials.empty()) return shifts;
  const auto trials = static_cast<double>(problem.trials.size());
  const auto& names = problem.trials.front()->trial_nuisances;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!names[i].shift_is_evidence) continue;
    double sum = 0.0;
    bool everywhere = true;
    for (std::size_t t = 0; t < problem.trials.size() && everywhere; ++t) {
      const auto& own = problem.trials[t]->trial_nuisances;
      everywhere = own.size() > i && own[i].name == names[i].name;
      if (everywhere) sum += point.nuisances[t][i] / own[i].sd;
    }
    if (everywhere)
      shifts.push_back(
          {names[i].name, names[i].port, sum / trials * std::sqrt(std::min(trials, kMostTrials))});
  }
  std::ranges::sort(shifts,
                    [](const CommonShift& a, const CommonShift& b) { return std::abs(a.z) > std::abs(b.z); });
  return shifts;
}

CommonShift largest_common_shift(const Problem& problem, const Point& point) {
  const auto shifts = common_shifts(problem, point);
  return shifts.empty() ? CommonShift{} : shifts.front();
}

double noise_change(const NoiseModel& before, const NoiseModel& now) {
  double sum = 0.0, count = 0.0;
  for (std::size_t c = 0; c < now.channels(); ++c) {
    const auto &a = before.channel(c), &b = now.channel(c);
    for (std::size_t p = 0; p < b.samples_of_phase.size(); ++p) {
      const double sd = b.sd_of_phase[p] / a.sd_of_phase[p];
      const double share_new =
          b.correlation_of_phase[p].innovation_sd / a.correlation_of_phase[p].innovation_sd;
      sum += b.samples_of_phase[p] * (std::pow(std::log(sd), 2) + std::pow(std::log(sd * share_new), 2));
      count += b.samples_of_phase[p];
    }
  }
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

}  // namespace sandhopper::diagnose
