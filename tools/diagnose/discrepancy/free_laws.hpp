#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/diagnose/fit/problem.hpp"

namespace sandhopper::diagnose {

// A family of laws of free form at one port: piecewise linear in one variable, perhaps times a sign.
struct FreeFamily {
  std::string port;
  bool sensor = false;
  std::string variable;  // what it is a function of, with unit as the plant's coordinates have it
  double scale = 1.0;
  std::vector<double> knots;    // ascending
  std::vector<FreeTerm> terms;  // one a knot
  bool of_model_error = false;  // what the port is a law of first of all
};

inline constexpr double kFreeLawInformation = 0.25;  // of a knot in scales of the port: prior sd 2

// Of values at knots that are an Ornstein-Uhlenbeck process along them, unit variance.
Eigen::MatrixXd knot_correlation(Eigen::Index knots);

// Prior information of a law's knots in scales of the port: each with sd 2, neighbours alike (an
// Ornstein-Uhlenbeck process along the knots).
Eigen::MatrixXd free_law_information(std::size_t knots);

// Families for every port of the plant and for every channel, over what the trials visit at `point`: between
// two knots lies an equal share of what they visit, every trial counting alike, so that what happens in
// milliseconds of a fast trial is resolved beside seconds of a slow one.
std::vector<FreeFamily> free_families(const Problem& problem, const Point& point);

// Those of one port over the states given, but for the few at the ends of each range.
std::vector<FreeFamily> free_families_over(const FreePort& port, const std::vector<PortState>& states,
                                           int knots);

// The edits of `base` with one term added.
Edits with_term(Edits base, const FreeTerm& term, double amplitude);
// The amplitude, in the port's scale, at which the derivative by a term is taken.
inline constexpr double kTermStep = 0.2;

}  // namespace sandhopper::diagnose
