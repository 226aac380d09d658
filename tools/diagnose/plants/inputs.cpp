#include "tools/diagnose/plants/inputs.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "tools/diagnose/fit/statistics.hpp"

namespace sandhopper::diagnose {

Samples samples_of(const Trial& trial, const std::string& channel) {
  Samples samples;
  if (const auto* values = trial.find(channel))
    for (std::size_t i = 0; i < values->size(); ++i)
      if (std::isfinite((*values)[i])) {
        samples.time_s.push_back(trial.time_s[i]);
        samples.value.push_back((*values)[i]);
      }
  return samples;
}

namespace {

// Weights of the third divided difference of four samples: a parabola through them gives 0. Where no row is
// missing they are those of even steps, because small differences between time stamps are their jitter.
std::array<double, 4> third_difference(std::span<const double, 4> time_s) {
  constexpr double kUneven = 1.5;  // ratio of two intervals from which a row is missing
  double least = time_s[1] - time_s[0], most = least;
  for (std::size_t i = 2; i < time_s.size(); ++i) {
    least = std::min(least, time_s[i] - time_s[i - 1]);
    most = std::max(most, time_s[i] - time_s[i - 1]);
  }
  if (most < kUneven * least) return {-1.0, 3.0, -3.0, 1.0};
  std::array<double, 4> weights{1.0, 1.0, 1.0, 1.0};
  for (std::size_t i = 0; i < weights.size(); ++i)
    for (std::size_t j = 0; j < weights.size(); ++j)
      if (j != i) weights[i] *= least / (time_s[i] - time_s[j]);
  return weights;
}

}  // namespace

double fluctuation_rms(const Samples& s) {
  std::vector<double> differences;
  for (std::size_t i = 0; i + 4 <= s.value.size(); ++i) {
    const auto weights = third_difference(std::span(s.time_s).subspan(i).first<4>());
    double sum = 0.0, squares = 0.0;
    for (std::size_t k = 0; k < weights.size(); ++k) {
      sum += weights[k] * s.value[i + k];
      squares += weights[k] * weights[k];
    }
    differences.push_back(std::abs(sum) / std::sqrt(squares));
  }
  if (differences.size() < 5) return 0.0;
  return 1.4826 * median(std::move(differences));
}

std::vector<double> last_turns(std::span<const double> position, double least) {
  std::vector<double> turns(position.size());
  std::size_t turn = 0, furthest = 0, done = 0;
  double sign = 0.0;  // direction of the motion; 0: unknown yet
  for (std::size_t i = 0; i < position.size(); ++i) {
    const double moved = position[i] - position[furthest];
    if (sign == 0.0) {
      if (std::abs(moved) > least) sign = std::copysign(1.0, moved);
      if (sign != 0.0) furthest = i;
    } else if (sign * moved >= 0.0) {
      furthest = i;
    } else if (-sign * moved > least) {
      while (done < furthest) turns[done++] = position[turn];
      turn = furthest;
      furthest = i;
      sign = -sign;
    }
  }
  while (done < position.size()) turns[done++] = position[turn];
  return turns;
}

double median_step_s(std::span<const double> time_s) {
  if (time_s.size() < 2) return 1e-3;
  std::vector<double> steps;
  for (std::size_t i = 1; i < time_s.size(); ++i) steps.push_back(time_s[i] - time_s[i - 1]);
  return std::max(median(std::move(steps)), 1e-6);
}

Smoothed smooth(const Samples& s, std::size_t half_width) {
  const std::size_t n = s.value.size();
  Smoothed out{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n)};
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t from = i > half_width ? i - half_width : 0;
    const std::size_t to = std::min(n, i + half_width + 1);
    const double span_s = std::max(s.time_s[to - 1] - s.time_s[from], 1e-9);
    Eigen::Matrix3d normal = Eigen::Matrix3d::Identity() * 1e-12;
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (std::size_t k = from; k < to; ++k) {
      const double u = (s.time_s[k] - s.time_s[i]) / span_s;
      const Eigen::Vector3d basis(1.0, u, u * u);
      normal += basis * basis.transpose();
      right += basis * s.value[k];
    }
    const Eigen::Vector3d fit = normal.ldlt().solve(right);
    out.value[i] = fit[0];
    out.rate[i] = fit[1] / span_s;
    out.curvature[i] = 2.0 * fit[2] / (span_s * span_s);
  }
  return out;
}

Samples without_repeats(const Samples& s) {
  std::size_t repeats = 0, longest = 0, run = 0;
  for (std::size_t i = 1; i < s.value.size(); ++i) {
    run = s.value[i] == s.value[i - 1] ? run + 1 : 0;
    repeats += run > 0;
    longest = std::max(longest, run);
  }
  // A log that holds values repeats nearly every value a few times. A resting or stuck sensor repeats one
  // value many times.
  if (s.value.size() < 20 || static_cast<double>(repeats) < 0.4 * static_cast<double>(s.value.size()) ||
      longest > 60)
    return s;
  Samples out;
  for (std::size_t i = 0; i < s.value.size(); ++i)
    if (i == 0 || s.value[i] != s.value[i - 1]) {
      out.time_s.push_back(s.time_s[i]);
      out.value.push_back(s.value[i]);
    }
  return out;
}

std::vector<double> ages_s(const Trial& trial, const std::string& channel, double rate_Hz) {
  constexpr int kPhases = 100, kRates = 15;  // tried phases; tried rates on each side
  constexpr double kAgree = 0.97;            // least share of the rows that a rate and phase must match
  constexpr double kRowsPerTick = 1.02;      // least rows per sample of a sensor that is slower than the rows
  constexpr double kRateUnknown = 0.12;      // largest relative error of the believed rate
  const auto* values = trial.find(channel);
  if (values == nullptr || trial.time_s.size() < 20 || rate_Hz <= 0.0) return {};
  const auto& t = trial.time_s;
  const double row_s = median_step_s(t);
  if (rate_Hz * row_s * kRowsPerTick > 1.0) return {};
  std::vector<std::size_t> fresh;
  for (std::size_t row = 0; row < t.size(); ++row)
    if (!std::isnan((*values)[row])) fresh.push_back(row);
  if (fresh.size() < 10) return {};
  const double periods = static_cast<double>(fresh.size() - 1), span_s = t[fresh.back()] - t[fresh.front()];
  struct Ticks {
    double rate_Hz, phase, agreeing;
  };
  std::vector<Ticks> tried;
  double most = 0.0;
  const auto try_rate = [&](double rate) {
    for (int i = 0; i < kPhases; ++i) {
      const double phase = static_cast<double>(i) / kPhases;
      double agreeing = 0.0, before = std::floor(t[0] * rate - phase);
      for (std::size_t row = 1; row < t.size(); ++row) {
        const double tick = std::floor(t[row] * rate - phase);
        agreeing += (tick > before) == !std::isnan((*values)[row]) ? 1.0 : 0.0;
        before = tick;
      }
      tried.push_back({rate, phase, agreeing});
      most = std::max(most, agreeing);
    }
  };
  const double enough = kAgree * static_cast<double>(t.size() - 1);
  try_rate(rate_Hz);
  if (most < enough)
    for (int r = -kRates; r <= kRates; ++r) {
      // The number of periods between the first and the last sample is known to within about one.
      const double rate = (periods + 1.2 * r / kRates) / span_s;
      if (std::abs(rate / rate_Hz - 1.0) < kRateUnknown) try_rate(rate);
    }
  if (most < enough) return {};
  // Mean age over all rates and phases that match as well as the best.
  std::vector<double> ages(fresh.size(), 0.0);
  double count = 0.0;
  for (const auto& ticks : tried) {
    if (ticks.agreeing < most - 0.5) continue;
    for (std::size_t i = 0; i < fresh.size(); ++i) {
      const double at_s = t[fresh[i]];
      const double age_s =
          at_s - (std::floor(at_s * ticks.rate_Hz - ticks.phase) + ticks.phase) / ticks.rate_Hz;
      // No sample is older than a row. If it seems to be, it was taken just after the previous row or just
      // before this one, whichever is nearer.
      ages[i] += age_s <= row_s ? age_s : age_s - row_s < 1.0 / ticks.rate_Hz - age_s ? row_s : 0.0;
    }
    ++count;
  }
  for (double& age : ages) age /= count;
  return ages;
}

Samples averaged(const Samples& s, double least_step_s) {
  const double step_s = median_step_s(s.time_s);
  const auto group = static_cast<std::size_t>(std::max(1.0, std::round(least_step_s / step_s)));
  if (group <= 1) return s;
  Samples out;
  for (std::size_t i = 0; i + group <= s.value.size();) {
    // A gap ends a group.
    std::size_t n = 1;
    while (n < group && s.time_s[i + n] - s.time_s[i + n - 1] < kGapSteps * step_s) ++n;
    double time = 0.0, value = 0.0;
    for (std::size_t k = i; k < i + n; ++k) {
      time += s.time_s[k];
      value += s.value[k];
    }
    if (n == group) {
      out.time_s.push_back(time / static_cast<double>(n));
      out.value.push_back(value / static_cast<double>(n));
    }
    i += n;
  }
  return out;
}

std::vector<Group> slow_groups(const Samples& samples, std::size_t most, double step) {
  std::vector<Group> groups;
  const double gap_s = kGapSteps * median_step_s(samples.time_s);
  double low = 0.0, high = 0.0;
  for (std::size_t i = 0; i < samples.value.size(); ++i) {
    const double value = samples.value[i];
    low = std::min(low, value);
    high = std::max(high, value);
    if (groups.empty() || groups.back().count >= most || high - low > step ||
        samples.time_s[i] - samples.time_s[i - 1] > gap_s) {
      groups.push_back({i, 0});
      low = high = value;
    }
    ++groups.back().count;
  }
  return groups;
}

Samples means(const Samples& samples, const std::vector<Group>& groups) {
  Samples out;
  for (const auto& group : groups) {
    const auto mean = [&](const std::vector<double>& v) {
      const auto from = v.begin() + static_cast<std::ptrdiff_t>(group.first);
      return std::accumulate(from, from + static_cast<std::ptrdiff_t>(group.count), 0.0) /
             static_cast<double>(group.count);
    };
    out.time_s.push_back(mean(samples.time_s));
    out.value.push_back(mean(samples.value));
  }
  return out;
}

Signal on_grid(const Samples& s, double start_s, double step_s, std::size_t count, bool hold) {
  Signal signal{start_s, step_s, std::vector<double>(count, 0.0)};
  if (s.empty()) return signal;
  constexpr double kLost = 3.5;  // in median steps: across a longer gap no value holds
  const double usual_s = median_step_s(s.time_s);
  std::size_t k = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = start_s + step_s * static_cast<double>(i);
    while (k + 1 < s.time_s.size() && s.time_s[k + 1] <= t) ++k;
    double value = s.value[k];
    const bool lost = k + 1 < s.time_s.size() && s.time_s[k + 1] - s.time_s[k] > kLost * usual_s;
    if ((!hold || lost) && k + 1 < s.time_s.size() && t > s.time_s[k])
      value += (s.value[k + 1] - s.value[k]) * (t - s.time_s[k]) / (s.time_s[k + 1] - s.time_s[k]);
    signal.values[i] = value;
  }
  return signal;
}

SensorBelief sensor_belief(const Belief& belief, const std::string& prefix, const std::string& unit) {
  SensorBelief sensor;
  sensor.bandwidth_Hz = belief.value("sensors." + prefix + "_bandwidth_Hz");
  if (sensor.bandwidth_Hz > kAsGoodAsNone_Hz) sensor.bandwidth_Hz = 0.0;
  sensor.latency_s = belief.value("sensors." + prefix + "_latency_s");
  const double range = belief.value("sensors." + prefix + "_range_" + unit);
  if (range > 0.0) {
    sensor.range_low = -range;
    sensor.range_high = range;
  }
  return sensor;
}

double range_of_setup(const std::vector<Trial>& trials, const std::string& key) {
  double least = 1e300, most = -1e300;
  for (const auto& trial : trials) {
    least = std::min(least, trial.setup_or(key, 0.0));
    most = std::max(most, trial.setup_or(key, 0.0));
  }
  return trials.empty() ? 0.0 : most - least;
}

}  // namespace sandhopper::diagnose
