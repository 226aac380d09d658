#pragma once
#include <string>

#include "tools/diagnose/fit/problem.hpp"

namespace sandhopper::diagnose {

// Answers of two simple methods, from the linear approximation at the belief. They are baselines for
// comparison.
struct SimpleAnswers {
  std::string largest_correlation;  // Effect whose signature correlates most with the residual.
  double correlation = 0.0;
  // Effect with the largest |size / typical| if all effects are fitted at once.
  std::string fit_every_parameter;
  double typicals = 0.0;
};
SimpleAnswers simple_answers(const Problem& problem, const Point& null);

}  // namespace sandhopper::diagnose
