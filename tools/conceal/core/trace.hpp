#pragma once
#include <string>
#include <vector>

namespace sandhopper::conceal {

// A quantity on an even grid of instants from time zero on, as the simulation left it.
struct Trace {
  double step_s = 1e-3;
  std::vector<double> values;

  // Between instants by a straight line, beyond the ends the last value.
  double at(double t_s) const;
};

Trace low_pass(const Trace& trace, double bandwidth_Hz);  // first order, exact for a held input
Trace second_order(const Trace& trace, double natural_Hz, double damping_ratio);
Trace shifted(const Trace& trace, double later_s);  // out(t) = in(t - later_s)
Trace stretched(const Trace& trace, double drift);  // out(t) = in(t (1 + drift))

}  // namespace sandhopper::conceal
