#include "tools/conceal/core/channel_faults.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sandhopper::conceal {
namespace {

// For each row: true during an episode. Episodes start at random with `rate_Hz` and last `length_s`. They are
// always drawn from their own stream, so that the rest of the recording does not depend on them.
std::vector<bool> episodes(const std::vector<double>& rows_s, double rate_Hz, double length_s,
                           Random random) {
  std::vector<bool> on(rows_s.size(), false);
  if (rate_Hz <= 0.0 || rows_s.empty()) return on;
  double next_s = rows_s.front() - std::log(1.0 - random.uniform()) / rate_Hz;
  for (std::size_t i = 0; i < rows_s.size(); ++i) {
    if (rows_s[i] >= next_s + length_s) next_s += length_s - std::log(1.0 - random.uniform()) / rate_Hz;
    on[i] = rows_s[i] >= next_s && rows_s[i] < next_s + length_s;
  }
  return on;
}

Trace through(const Trace& truth, const ChannelChain& chain, const ChannelFaults& faults) {
  Trace out = chain.bandwidth_Hz > 0.0 ? low_pass(truth, chain.bandwidth_Hz) : truth;
  if (faults.lag_s > 0.0) out = low_pass(out, 1.0 / (2.0 * 3.14159265358979 * faults.lag_s));
  if (faults.drift != 0.0) out = stretched(out, faults.drift);
  const double late_s = chain.latency_s + faults.late_s;
  return late_s == 0.0 ? out : shifted(out, late_s);
}

}  // namespace

void record_channel(Table& table, const std::string& name, const Trace& truth,
                    const std::vector<double>& rows_s, const ChannelChain& chain, const ChannelFaults& faults,
                    const TrialRandom& trial) {
  const auto signal = through(truth, chain, faults);
  auto noise = trial.noise("noise " + name);
  const double phase = trial.stream("phase " + name).uniform();
  const auto dropped =
      episodes(rows_s, faults.dropout_rate_Hz, faults.dropout_s, trial.stream("dropout " + name));
  const auto stuck = episodes(rows_s, faults.stuck_rate_Hz, faults.stuck_s, trial.stream("stuck " + name));

  auto& column = table.add(name, chain.decimals);
  column.values.reserve(rows_s.size());
  double last = std::numeric_limits<double>::quiet_NaN();
  double sample_before = -1e9;
  for (std::size_t i = 0; i < rows_s.size(); ++i) {
    double at_s = rows_s[i];
    if (chain.rate_Hz > 0.0) {
      at_s = (std::floor(rows_s[i] * chain.rate_Hz - phase) + phase) / chain.rate_Hz;
      if (at_s <= sample_before + 1e-9 || at_s < 0.0) {
        column.values.push_back(std::numeric_limits<double>::quiet_NaN());
        continue;
      }
      sample_before = at_s;
    }
    double value =
        faults.gain * signal.at(at_s) + faults.offset + chain.offset + noise.normal(0.0, chain.noise);
    if (faults.limit > 0.0) value = std::clamp(value, -faults.limit, faults.limit);
    if (dropped[i]) value = 0.0;
    if (stuck[i] && !std::isnan(last)) value = last;
    if (chain.quantum > 0.0) value = chain.quantum * std::round(value / chain.quantum);
    last = value;
    column.values.push_back(value);
  }
}

}  // namespace sandhopper::conceal
