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

  // Cubic (Catmull-Rom) between grid points, so that a delay of a fraction of a step is a delay; the end
  // values hold outside.
  double at(double time_s) const;
  void low_pass(double time_constant_s);  // first-order, starts settled
};

// What the belief says about a sensor.
struct SensorBelief {
  double bandwidth_Hz = 0.0;  // 0: none
  double latency_s = 0.0;
  double range_low = -1e300;
  double range_high = 1e300;
};

// Turns a true signal into what a sensor would record at `times_s`: low-pass, lag, delay, gain, offset, added
// law, range. `signal` is used up.
void observe(Signal& signal, const SensorBelief& sensor, const Edits& edits, std::string_view channel,
             std::span<const double> times_s, std::span<double> out);

}  // namespace sandhopper::diagnose
