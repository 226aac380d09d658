#pragma once
#include <string>
#include <vector>

#include "tools/diagnose/problem.hpp"

namespace sandhopper::diagnose {

// A family of laws of free form at one port: piecewise linear in one variable, perhaps times a sign.
struct FreeFamily {
  std::string port;
  bool sensor = false;
  std::string variable;  // what it is a function of, with unit as the plant's coordinates have it
  double scale = 1.0;
  double low = 0.0, high = 0.0;
  std::vector<FreeTerm> terms;
};

inline constexpr double kFreeLawInformation = 0.25;  // of a knot in scales of the port: prior sd 2

// Families for every port of the plant and for every channel, over the ranges that the trials visit at
// `point`.
std::vector<FreeFamily> free_families(const Problem& problem, const Point& point);

// Those of one port over the states given, but for the few at the ends of each range.
std::vector<FreeFamily> free_families_over(const FreePort& port, const std::vector<PortState>& states,
                                           int knots);

// The edits of `base` with one term added.
Edits with_term(Edits base, const FreeTerm& term, double amplitude);

}  // namespace sandhopper::diagnose
