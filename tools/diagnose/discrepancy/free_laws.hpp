#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/diagnose/fit/problem.hpp"

namespace sandhopper::diagnose {

// Laws of free form at one port: piecewise linear in one variable, multiplied by a weight (for some variables
// a sign or another factor of the state).
struct FreeFamily {
  std::string port;
  bool sensor = false;
  std::string variable;  // Variable of the law, with unit, named like the plant's coordinates.
  double scale = 1.0;
  std::vector<double> knots;    // ascending
  std::vector<FreeTerm> terms;  // One hat function per knot.
  // True if the port's own law depends on this variable, so that model error takes this form.
  bool of_model_error = false;
};

// Prior information of the value at a knot, in scales of the port: standard deviation 2.
inline constexpr double kFreeLawInformation = 0.25;

// Correlation matrix of an Ornstein-Uhlenbeck process at equally spaced knots; correlation length two knots.
Eigen::MatrixXd knot_correlation(Eigen::Index knots);

// Prior information matrix of the values at the knots, in scales of the port: standard deviation 2 each,
// correlated as in `knot_correlation`.
Eigen::MatrixXd free_law_information(std::size_t knots);

// Families for every port of the plant and every channel, over the values that the simulation visits at
// `point`. The knots are quantiles: an equal share of the samples lies between two knots, with equal weight
// for each trial. So milliseconds of a fast trial are resolved beside seconds of a slow one.
std::vector<FreeFamily> free_families(const Problem& problem, const Point& point);

// Families of one port over the given states, with `knots` equally spaced knots. The outermost 0.5 % of the
// values at each end are ignored.
std::vector<FreeFamily> free_families_over(const FreePort& port, const std::vector<PortState>& states,
                                           int knots);

// The edits of `base` with one term added.
Edits with_term(Edits base, const FreeTerm& term, double amplitude);
// Amplitude, in the port's scale, for the finite difference of a term.
inline constexpr double kTermStep = 0.2;

}  // namespace sandhopper::diagnose
