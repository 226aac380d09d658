#pragma once
#include <cstddef>
#include <span>

#include "terrain/bed.hpp"

namespace sandhopper::diagnose {

// Fluctuation of the bed along depth with an exponential correlation over `length_m`. Its knots k_i come from
// independent nuisances e_i, each with the relative standard deviation, by a first-order recursion:
//   k_0 = e_0,  k_i = rho k_(i-1) + sqrt(1 - rho^2) e_i
// rho is chosen so that the mean over a depth D has the right variance: 2 length / D times that of the
// fluctuation (twice the integral of exp(-s / length)). With a smaller one, chance would look like a
// difference between trials.
class BedGrains {
 public:
  BedGrains() = default;
  // Knots every `spacing_m` from the surface to `deepest_m`, at most `most_knots`. None if `relative` is 0.
  BedGrains(double relative, double length_m, double deepest_m, double spacing_m, std::size_t most_knots);

  std::size_t count() const { return count_; }
  double sd() const { return relative_; }
  double between_knots() const;  // relative standard deviation that interpolation between knots misses
  BedFluctuation fluctuation(std::span<const double> nuisances) const;

 private:
  std::size_t count_ = 0;
  double relative_ = 0.0, length_m_ = 0.0, spacing_m_ = 0.0, keep_ = 0.0;
};

}  // namespace sandhopper::diagnose
