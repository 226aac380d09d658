#include "tools/conceal/core/trace.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandhopper::conceal {
namespace {

template <class Time>
Trace resampled(const Trace& trace, const Time& time_s) {
  Trace out{trace.step_s, trace.values};
  for (std::size_t i = 0; i < out.values.size(); ++i)
    out.values[i] = trace.at(time_s(trace.step_s * static_cast<double>(i)));
  return out;
}

}  // namespace

double Trace::at(double t_s) const {
  if (values.empty()) return 0.0;
  const double place = std::clamp(t_s / step_s, 0.0, static_cast<double>(values.size() - 1));
  const auto left = std::min(static_cast<std::size_t>(place), values.size() - 1);
  const auto right = std::min(left + 1, values.size() - 1);
  const double share = place - static_cast<double>(left);
  return values[left] + share * (values[right] - values[left]);
}

Trace low_pass(const Trace& trace, double bandwidth_Hz) {
  if (bandwidth_Hz <= 0.0) return trace;
  Trace out = trace;
  const double keep = std::exp(-2.0 * std::numbers::pi * bandwidth_Hz * trace.step_s);
  for (std::size_t i = 1; i < out.values.size(); ++i)
    out.values[i] = trace.values[i] + keep * (out.values[i - 1] - trace.values[i]);
  return out;
}

Trace second_order(const Trace& trace, double natural_Hz, double damping_ratio) {
  Trace out = trace;
  if (out.values.empty()) return out;
  const double w = 2.0 * std::numbers::pi * natural_Hz, h = trace.step_s;
  double y = trace.values.front(), rate = 0.0;
  for (std::size_t i = 1; i < out.values.size(); ++i) {
    // Implicit in the rate, so stable for any step.
    rate = (rate + h * w * w * (trace.values[i] - y)) / (1.0 + 2.0 * damping_ratio * w * h + w * w * h * h);
    y += h * rate;
    out.values[i] = y;
  }
  return out;
}

Trace shifted(const Trace& trace, double later_s) {
  return resampled(trace, [&](double t_s) { return t_s - later_s; });
}

Trace stretched(const Trace& trace, double drift) {
  return resampled(trace, [&](double t_s) { return t_s / (1.0 + drift); });
}

}  // namespace sandhopper::conceal
