#pragma once
#include <string>
#include <vector>

namespace sandhopper::conceal {

// A simulated quantity at equally spaced times, starting at zero.
struct Trace {
  double step_s = 1e-3;
  std::vector<double> values;

  // Linear interpolation; beyond the ends the last value.
  double at(double t_s) const;
};

// First order; exact for an input that is constant over a step.
Trace low_pass(const Trace& trace, double bandwidth_Hz);
// y'' = w^2 (x - y) - 2 zeta w y', w = 2 pi natural_Hz, zeta = damping_ratio.
Trace second_order(const Trace& trace, double natural_Hz, double damping_ratio);
Trace shifted(const Trace& trace, double later_s);  // out(t) = in(t - later_s)
Trace stretched(const Trace& trace, double drift);  // out(t) = in(t / (1 + drift))

}  // namespace sandhopper::conceal
