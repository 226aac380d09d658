#pragma once
#include <cmath>

#include "tools/diagnose/fit/fit.hpp"
#include "tools/diagnose/fit/prepare.hpp"

namespace sandhopper::diagnose {

// A problem whose noise and derivatives are those beside the believed physics, as before a search.
inline Problem prepared(const Recordings& recordings) {
  Problem problem = prepare(recordings).problem;
  const Point point = fit_from(problem, null_point(problem), {.max_iterations = 6}).point;
  update_noise(problem, point);
  keep_columns(problem, point);
  return problem;
}

// Quadratic drag of the body of `drops`, N.
inline double dragged(double /*t_s*/, double /*height_m*/, double velocity_mps) {
  return -0.5 * 1.2 * 0.01 * 0.5 * std::abs(velocity_mps) * velocity_mps;
}

}  // namespace sandhopper::diagnose
