#include "tools/diagnose/model/signal.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandhopper::diagnose {

double Signal::at(double time_s) const {
  const auto n = static_cast<std::ptrdiff_t>(values.size());
  if (n == 0) return 0.0;
  const double place = std::clamp((time_s - start_s) / step_s, 0.0, static_cast<double>(n - 1));
  const auto i =
      std::min<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(place), std::max<std::ptrdiff_t>(n - 2, 0));
  const double u = place - static_cast<double>(i);
  const double* v = values.data();
  const double b = v[i], c = v[std::min(i + 1, n - 1)];
  const double a = i > 0 ? v[i - 1] : b, d = i + 2 < n ? v[i + 2] : c;
  return b + 0.5 * u * (c - a + u * (2.0 * a - 5.0 * b + 4.0 * c - d + u * (3.0 * (b - c) + d - a)));
}

void Signal::low_pass(double time_constant_s) {
  if (values.empty() || time_constant_s <= 0.0) return;
  const double ratio = step_s / time_constant_s;
  const double decay = std::exp(-ratio);
  double before = values.front(), state = values.front();
  if (means) {
    for (double& value : values) value = state = decay * state + (1.0 - decay) * value;
    start_s += 0.5 * step_s;
    means = false;
    return;
  }
  const double slope_gain = 1.0 - (1.0 - decay) / ratio;
  for (double& value : values) {
    const double now = value;
    state = decay * state + (1.0 - decay) * before + slope_gain * (now - before);
    before = now;
    value = state;
  }
}

namespace {

// The mean of the signal over a window centred on an instant, by Simpson's rule.
double mean_around(const Signal& signal, double at_s, double window_s) {
  const double q = 0.25 * window_s;
  return (signal.at(at_s - 2.0 * q) + 4.0 * (signal.at(at_s - q) + signal.at(at_s + q)) +
          2.0 * signal.at(at_s) + signal.at(at_s + 2.0 * q)) /
         12.0;
}

}  // namespace

void observe(Signal& signal, const SensorBelief& sensor, const Edits& edits, std::string_view channel,
             std::span<const double> times_s, std::span<double> out) {
  if (sensor.bandwidth_Hz > 0.0) signal.low_pass(1.0 / (2.0 * std::numbers::pi * sensor.bandwidth_Hz));
  const SensorClock clock(edits, channel, sensor.latency_s);
  double gain = 1.0, offset = 0.0, mean_share = 0.0, window_s = 0.0;
  double low = sensor.range_low, high = sensor.range_high;
  std::vector<const Law*> laws;
  for (const auto& edit : edits.sensors) {
    if (edit.channel != channel) continue;
    switch (edit.kind) {
      case SensorEdit::Kind::gain:
        gain *= edit.value;
        break;
      case SensorEdit::Kind::offset:
        offset += edit.value;
        break;
      case SensorEdit::Kind::lag_s:
        signal.low_pass(edit.value);
        break;
      case SensorEdit::Kind::delay_s:
      case SensorEdit::Kind::time_scale:
        break;  // SensorClock applies these
      case SensorEdit::Kind::clip_high:
        high = std::min(high, edit.value);
        break;
      case SensorEdit::Kind::clip_low:
        low = std::max(low, edit.value);
        break;
      case SensorEdit::Kind::mean_share:
        mean_share += edit.value;
        window_s = edit.window_s;
        break;
      case SensorEdit::Kind::law:
        laws.push_back(&edit.law);
        break;
    }
  }
  const double half_s = 0.5 * signal.step_s;
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    const double at_s = clock.taken_s(times_s[i]);
    double value = signal.at(at_s);
    if (mean_share != 0.0) value += mean_share * (mean_around(signal, at_s, window_s) - value);
    value = gain * value + offset;
    if (!laws.empty())
      value += sum_of(
          laws, SensorState{.time_s = at_s,
                            .value = value,
                            .rate = (signal.at(at_s + half_s) - signal.at(at_s - half_s)) / signal.step_s});
    out[i] = std::clamp(value, low, high);
  }
}

}  // namespace sandhopper::diagnose
