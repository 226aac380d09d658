#include "tools/diagnose/fit/noise_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace sandhopper::diagnose {
namespace {

constexpr std::size_t kOrder = 3;        // greatest order of an autoregression
constexpr double kTooFewSamples = 30.0;  // a phase with fewer takes the standard deviation of its channel
constexpr double kTooFewForCorrelation = 200.0;  // a phase with fewer takes the autoregression of its channel
constexpr double kOutlier = 6.0;  // in robust standard deviations: larger residuals do not count
// In standard deviations: larger residuals are clipped for the correlation.
constexpr double kMostOfOne = 4.0;

double median_magnitude(std::vector<double> values) {
  if (values.empty()) return 0.0;
  for (double& v : values) v = std::abs(v);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Autoregression by Levinson's recursion. Its order, at most kOrder, minimises Akaike's criterion.
Autoregression levinson(const std::vector<double>& correlation, double samples) {
  std::vector<double> a, best;
  double error = 1.0, best_error = 1.0, best_score = 0.0;
  for (std::size_t m = 1; m < correlation.size(); ++m) {
    double reflection = correlation[m];
    for (std::size_t j = 1; j < m; ++j) reflection -= a[j - 1] * correlation[m - j];
    reflection = std::clamp(reflection / error, -0.995, 0.995);
    std::vector<double> next(m);
    next[m - 1] = reflection;
    for (std::size_t j = 1; j < m; ++j) next[j - 1] = a[j - 1] - reflection * a[m - j - 1];
    a = std::move(next);
    error *= 1.0 - reflection * reflection;
    const double score = samples * std::log(error) + 2.0 * static_cast<double>(m);
    if (score < best_score) {
      best_score = score;
      best = a;
      best_error = error;
    }
  }
  return {best, std::sqrt(std::max(best_error, 1e-4))};
}

// Sums of products of scaled residuals, lag by lag.
struct Products {
  std::array<double, kOrder + 1> sums{}, counts{};

  void add(std::size_t lag, double product) {
    sums[lag] += product;
    ++counts[lag];
  }
  Autoregression autoregression() const {
    const double variance = counts[0] > 0.0 ? sums[0] / counts[0] : 0.0;
    if (counts[0] < kTooFewSamples || variance <= 0.0) return {};
    std::vector<double> correlation;
    for (std::size_t lag = 0; lag <= kOrder; ++lag)
      correlation.push_back(counts[lag] > 0.0 ? sums[lag] / counts[lag] / variance : 0.0);
    return levinson(correlation, counts[0]);
  }
};

// Residuals of all trials, and which of them count.
struct Sample {
  const std::vector<const TrialModel*>& trials;
  const std::vector<std::vector<std::uint8_t>>& used;
  const std::vector<Eigen::VectorXd>& residuals;
};

// Root mean square without outliers, at least `floor_sd`.
double spread(const std::vector<double>& values, double floor_sd) {
  const double limit = kOutlier * 1.4826 * std::max(median_magnitude(values), 1e-300);
  double sum = 0.0, count = 0.0;
  for (const double v : values)
    if (std::abs(v) <= limit) {
      sum += v * v;
      ++count;
    }
  return std::max(count > 0.0 ? std::sqrt(sum / count) : 0.0, floor_sd);
}

// Standard deviations of one channel by phase. A phase with few samples takes that of the whole channel.
ChannelNoise levels_of(const Sample& sample, std::size_t channel, std::size_t phases, double floor_sd) {
  ChannelNoise noise;
  std::vector<std::vector<double>> of_phase(phases);
  std::vector<double> all;
  for (std::size_t t = 0; t < sample.trials.size(); ++t)
    for (std::size_t k = 0; k < sample.trials[t]->rows.size(); ++k) {
      const Row& row = sample.trials[t]->rows[k];
      if (row.channel != channel || !sample.used[t][k] || row.at_limit) continue;
      const double r = sample.residuals[t][static_cast<Eigen::Index>(k)] /
                       std::hypot(row.relative_sd, row.numerical_sd / floor_sd);
      of_phase[row.phase].push_back(r);
      all.push_back(r);
    }
  const double overall = all.empty() ? std::max(floor_sd, 1e-12) : spread(all, floor_sd);
  noise.sd_of_phase.assign(phases, overall);
  noise.samples_of_phase.assign(phases, 0.0);
  for (std::size_t p = 0; p < phases; ++p) {
    noise.samples_of_phase[p] = static_cast<double>(of_phase[p].size());
    if (noise.samples_of_phase[p] >= kTooFewSamples) noise.sd_of_phase[p] = spread(of_phase[p], floor_sd);
  }
  return noise;
}

// Estimates the autoregressions of one channel from its scaled residuals; outliers are clipped.
void take_correlations(const Sample& sample, std::size_t channel, std::size_t phases, double floor_sd,
                       ChannelNoise& noise) {
  Products all_phases;
  std::vector<Products> products(phases);
  for (std::size_t t = 0; t < sample.trials.size(); ++t) {
    std::vector<double> chain;
    const Row* before = nullptr;
    for (std::size_t k = 0; k < sample.trials[t]->rows.size(); ++k) {
      const Row& row = sample.trials[t]->rows[k];
      if (row.channel != channel) continue;
      if (before != nullptr && before->block != row.block) chain.clear();
      before = &row;
      if (!sample.used[t][k] || row.at_limit) {
        chain.clear();
        continue;
      }
      const double sd = std::hypot(row.relative_sd * noise.sd_of_phase[row.phase], row.numerical_sd);
      const double e =
          std::clamp(sample.residuals[t][static_cast<Eigen::Index>(k)] / sd, -kMostOfOne, kMostOfOne);
      chain.push_back(e);
      for (std::size_t lag = 0; lag <= kOrder && lag < chain.size(); ++lag) {
        all_phases.add(lag, e * chain[chain.size() - 1 - lag]);
        products[row.phase].add(lag, e * chain[chain.size() - 1 - lag]);
      }
    }
  }
  for (std::size_t p = 0; p < phases; ++p) {
    const bool enough = products[p].counts[0] >= kTooFewForCorrelation;
    auto correlation = (enough ? products[p] : all_phases).autoregression();
    // The sensor's own noise is white and cannot be predicted from the past, so it bounds the innovation from
    // below.
    const double white = std::min(1.0, floor_sd / noise.sd_of_phase[p]);
    correlation.innovation_sd = std::max(correlation.innovation_sd, white);
    noise.correlation_of_phase.push_back(std::move(correlation));
  }
}

}  // namespace

void NoiseModel::fix(std::size_t channel, double sd) {
  auto& noise = channels_[channel];
  noise.sd_of_phase.assign(noise.sd_of_phase.size(), sd);
  noise.correlation_of_phase.assign(noise.sd_of_phase.size(), {});
}

double ChannelNoise::sd() const {
  double sum = 0.0, count = 0.0;
  for (std::size_t p = 0; p < sd_of_phase.size(); ++p) {
    const double n = p < samples_of_phase.size() ? samples_of_phase[p] : 1.0;
    sum += n * sd_of_phase[p] * sd_of_phase[p];
    count += n;
  }
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

void NoiseModel::widen(double factor) {
  for (auto& channel : channels_)
    for (double& sd : channel.sd_of_phase) sd *= factor;
}

double NoiseModel::sd(const TrialModel& trial, const Row& row) const {
  const double factor = trial.noise_factor.empty() ? 1.0 : trial.noise_factor[row.channel];
  return std::hypot(factor * row.relative_sd * channels_[row.channel].sd_of_phase[row.phase],
                    row.numerical_sd);
}

void NoiseModel::whiten(const TrialModel& trial, const std::vector<std::uint8_t>& used,
                        Eigen::Ref<Eigen::MatrixXd> values) const {
  const std::size_t rows = trial.rows.size();
  // Number of used rows directly before each row, in the same channel and block, at most kOrder.
  std::vector<std::uint8_t> before(rows, 0);
  for (std::size_t k = 1; k < rows; ++k)
    if (used[k] && used[k - 1] && trial.rows[k].channel == trial.rows[k - 1].channel &&
        trial.rows[k].block == trial.rows[k - 1].block)
      before[k] = static_cast<std::uint8_t>(std::min<std::size_t>(before[k - 1] + 1u, kOrder));
  // The filter along a column: w_k = (e_k - a_1 e_{k-1} - …) / s with e_k = value_k / sd_k.
  const auto n = static_cast<Eigen::Index>(rows);
  Eigen::ArrayXd sds = Eigen::ArrayXd::Zero(n);  // 0: the row is not used and may hold anything
  Eigen::ArrayXd innovation = Eigen::ArrayXd::Ones(n);
  Eigen::ArrayXXd past = Eigen::ArrayXXd::Zero(n, kOrder);
  for (std::size_t k = 0; k < rows; ++k) {
    if (!used[k]) continue;
    const auto i = static_cast<Eigen::Index>(k);
    const Row& row = trial.rows[k];
    sds[i] = sd(trial, row);
    const auto& [a, innovation_sd] = channels_[row.channel].correlation_of_phase[row.phase];
    if (before[k] < a.size()) continue;
    innovation[i] = innovation_sd;
    for (std::size_t j = 0; j < a.size(); ++j) past(i, static_cast<Eigen::Index>(j)) = a[j];
  }
  Eigen::ArrayXd scaled(n);
  for (Eigen::Index c = 0; c < values.cols(); ++c) {
    auto column = values.col(c).array();
    scaled = (sds > 0.0).select(column / sds, 0.0);
    column = scaled;
    for (Eigen::Index lag = 1; lag <= static_cast<Eigen::Index>(kOrder) && lag < n; ++lag)
      column.tail(n - lag) -= past.col(lag - 1).tail(n - lag) * scaled.head(n - lag);
    column /= innovation;
  }
}

double NoiseModel::log_determinant(const TrialModel& trial, const std::vector<std::uint8_t>& used) const {
  // W is triangular and reaches back kOrder rows. An impulse in every (kOrder + 1)th row shows its diagonal.
  constexpr Eigen::Index kApart = static_cast<Eigen::Index>(kOrder) + 1;
  const auto rows = static_cast<Eigen::Index>(trial.rows.size());
  double sum = 0.0;
  for (Eigen::Index first = 0; first < kApart; ++first) {
    Eigen::MatrixXd impulses = Eigen::MatrixXd::Zero(rows, 1);
    for (Eigen::Index k = first; k < rows; k += kApart) impulses(k, 0) = 1.0;
    whiten(trial, used, impulses);
    for (Eigen::Index k = first; k < rows; k += kApart)
      if (used[static_cast<std::size_t>(k)]) sum += std::log(impulses(k, 0));
  }
  return sum;
}

NoiseModel estimate_noise(const std::vector<const TrialModel*>& trials,
                          const std::vector<std::vector<std::uint8_t>>& used,
                          const std::vector<Eigen::VectorXd>& residuals, std::size_t phases,
                          std::span<const double> floor_sd) {
  const Sample sample{trials, used, residuals};
  std::vector<ChannelNoise> channels;
  for (std::size_t c = 0; c < floor_sd.size(); ++c) {
    channels.push_back(levels_of(sample, c, phases, floor_sd[c]));
    take_correlations(sample, c, phases, floor_sd[c], channels.back());
  }
  return NoiseModel(std::move(channels));
}

NoiseModel white_noise(std::span<const double> sd, std::size_t phases) {
  std::vector<ChannelNoise> channels(sd.size());
  for (std::size_t c = 0; c < sd.size(); ++c) {
    channels[c].sd_of_phase.assign(phases, sd[c]);
    channels[c].samples_of_phase.assign(phases, 1.0);
    channels[c].correlation_of_phase.assign(phases, {});
  }
  return NoiseModel(std::move(channels));
}

}  // namespace sandhopper::diagnose
