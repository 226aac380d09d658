#pragma once
#include <cstddef>
#include <span>

#include "terrain/bed.hpp"

namespace sandhopper::diagnose {

// The bed's fluctuation along depth, exponentially correlated over `length_m`, as independent nuisances of
// one standard deviation, the relative one, through a first-order recursion over knots:
//   k_0 = e_0,  k_i = rho k_(i-1) + sqrt(1 - rho^2) e_i
// rho is such that the mean over a depth D has the variance it ought to have, 2 length / D of the
// fluctuation's own (twice the integral of exp(-s / length)); with less of it chance would pass for what
// trials differ in.
class BedGrains {
 public:
  BedGrains() = default;
  // From the surface to `deepest_m`, over knots no closer than `closest_m`; none where nothing fluctuates.
  BedGrains(double relative, double length_m, double deepest_m, double closest_m, std::size_t most_knots);

  std::size_t count() const { return count_; }
  double sd() const { return relative_; }
  double between_knots() const;  // relative; what lines between knots leave
  BedFluctuation fluctuation(std::span<const double> nuisances) const;

 private:
  std::size_t count_ = 0;
  double relative_ = 0.0, length_m_ = 0.0, spacing_m_ = 0.0, keep_ = 0.0;
};

}  // namespace sandhopper::diagnose
