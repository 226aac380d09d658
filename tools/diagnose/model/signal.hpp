#pragma once
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "tools/diagnose/model/edits.hpp"

namespace sandhopper::diagnose {

// A quantity on a uniform grid of time.
struct Signal {
  double start_s = 0.0;
  double step_s = 1e-3;
  std::vector<double> values;
  // True if a value is the mean over the step around its grid point. Such a signal may jump between two
  // steps, e.g. where a command changes.
  bool means = false;

  // Value at a time. Cubic (Catmull-Rom) between grid points, so that a delay of a fraction of a step is
  // represented. Outside the grid the end values hold.
  double at(double time_s) const;
  // First-order, starts settled. Exact for an input that is linear between grid points, or, if `means`,
  // constant over each step; the grid then moves to the ends of the steps.
  void low_pass(double time_constant_s);
};

// Sensor model of the belief; range in the channel's unit.
struct SensorBelief {
  double bandwidth_Hz = 0.0;  // 0: no low-pass
  double latency_s = 0.0;
  double range_low = -1e300;
  double range_high = 1e300;
};

// Simulates a sensor: writes the readings of `signal` at `times_s` to `out`. Order: low-pass, lag, delay,
// mean over a window, gain, offset, law, range. Overwrites `signal`.
void observe(Signal& signal, const SensorBelief& sensor, const Edits& edits, std::string_view channel,
             std::span<const double> times_s, std::span<double> out);

}  // namespace sandhopper::diagnose
