#include "terrain/accelerometer_fusion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace sandhopper {
namespace {

using Believed = std::vector<bool>;

// False for saturated samples: runs near an extreme of the whole record with far less noise than elsewhere,
// and the guard samples around them.
Believed away_from_saturation(std::span<const double> values, const FusionOptions& options,
                              AccelerometerCalibration& calibration) {
  Believed believed(values.size(), true);
  const double low = *std::min_element(values.begin(), values.end());
  const double high = *std::max_element(values.begin(), values.end());
  const double noise = sample_noise(values, believed);
  const auto at_end = [&](std::size_t i) {
    return values[i] >= high - 2.0 * noise || values[i] <= low + 2.0 * noise;
  };
  const auto stands_still = [&](std::size_t i) {
    return i == 0 || std::abs(values[i] - values[i - 1]) <= 0.25 * noise;
  };
  std::size_t run = 0;
  for (std::size_t i = 0; i <= values.size(); ++i) {
    const bool end = i < values.size() && at_end(i);
    if (end && (run == 0 || stands_still(i))) {
      ++run;
      continue;
    }
    if (run >= options.fewest_saturated) {
      calibration.saturated_samples += run;
      const std::size_t from = i - run - std::min(i - run, options.guard_samples);
      const std::size_t to = std::min(i + options.guard_samples, values.size());
      std::fill(believed.begin() + static_cast<std::ptrdiff_t>(from),
                believed.begin() + static_cast<std::ptrdiff_t>(to), false);
    }
    run = end ? 1 : 0;
  }
  calibration.saturation_mps2 = std::max(std::abs(low), std::abs(high));
  return believed;
}

// Regression reference = scale x channel + bias on the averaged signals.
void regress(std::span<const double> channel, std::span<const double> reference, const Believed& believed,
             AccelerometerCalibration& out) {
  double n = 0.0, sx = 0.0, sy = 0.0;
  for (std::size_t i = 0; i < channel.size(); ++i)
    if (believed[i]) {
      n += 1.0;
      sx += channel[i];
      sy += reference[i];
    }
  if (n < 2.0) return;
  double xx = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < channel.size(); ++i)
    if (believed[i]) {
      xx += (channel[i] - sx / n) * (channel[i] - sx / n);
      xy += (channel[i] - sx / n) * (reference[i] - sy / n);
    }
  out.scale = xx > 0.0 ? xy / xx : 1.0;
  out.bias_mps2 = sy / n - out.scale * sx / n;
}

}  // namespace

double sample_noise(std::span<const double> values, const std::vector<bool>& used) {
  std::vector<double> differences;
  for (std::size_t i = 1; i + 1 < values.size(); ++i)
    if (used.empty() || used[i])
      differences.push_back(std::abs(values[i + 1] - 2.0 * values[i] + values[i - 1]));
  if (differences.empty()) return std::numeric_limits<double>::infinity();
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  return *middle / (0.6745 * std::sqrt(6.0));
}

std::vector<double> moving_average(std::span<const double> values, std::size_t samples) {
  std::vector<double> sums(values.size() + 1, 0.0), out(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) sums[i + 1] = sums[i] + values[i];
  const std::size_t half = samples / 2;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t reach = std::min({half, i, values.size() - 1 - i});
    out[i] = (sums[i + reach + 1] - sums[i - reach]) / static_cast<double>(2 * reach + 1);
  }
  return out;
}

FusedAcceleration fuse_accelerometers(std::span<const std::span<const double>> channels_mps2,
                                      const FusionOptions& options) {
  const std::size_t count = channels_mps2.size();
  if (count == 0 || channels_mps2[0].empty()) throw std::invalid_argument("no accelerometer");
  FusedAcceleration out;
  out.calibration.resize(count);
  std::vector<Believed> believed(count);
  std::vector<std::vector<double>> averaged(count);
  out.reference = count;
  for (std::size_t c = 0; c < count; ++c) {
    auto& calibration = out.calibration[c];
    believed[c] = away_from_saturation(channels_mps2[c], options, calibration);
    calibration.noise_mps2 = sample_noise(channels_mps2[c], believed[c]);
    averaged[c] = moving_average(channels_mps2[c], options.average_samples);
    if (calibration.saturated_samples > 0) continue;
    if (out.reference == count || calibration.noise_mps2 < out.calibration[out.reference].noise_mps2)
      out.reference = c;
  }
  if (out.reference == count) throw std::invalid_argument("every accelerometer saturates");
  for (std::size_t c = 0; c < count; ++c)
    if (c != out.reference) regress(averaged[c], averaged[out.reference], believed[c], out.calibration[c]);

  const auto reference = channels_mps2[out.reference];
  for (std::size_t i = 0; i < reference.size(); ++i) {
    std::size_t best = out.reference;
    for (std::size_t c = 0; c < count; ++c) {
      const auto& calibration = out.calibration[c];
      if (!believed[c][i] || calibration.noise_mps2 >= out.calibration[best].noise_mps2) continue;
      const double noise = std::hypot(calibration.noise_mps2, out.calibration[out.reference].noise_mps2);
      const double difference =
          calibration.scale * channels_mps2[c][i] + calibration.bias_mps2 - reference[i];
      if (std::abs(difference) < options.outlier_sigma * noise) best = c;
    }
    const auto& calibration = out.calibration[best];
    out.source.push_back(best);
    out.specific_force_mps2.push_back(calibration.scale * channels_mps2[best][i] + calibration.bias_mps2);
  }
  return out;
}

}  // namespace sandhopper
