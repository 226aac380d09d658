#pragma once
#include <string>

#include "tools/diagnose/fit/problem.hpp"

namespace sandhopper::diagnose {

// What plainer methods would have said, from the first linear approximation at what is believed: to be
// beaten.
struct SimpleAnswers {
  std::string largest_correlation;  // the effect whose signature correlates most with what is left
  double correlation = 0.0;
  std::string fit_every_parameter;  // all effects fitted at once: the largest in its typical size
  double typicals = 0.0;
};
SimpleAnswers simple_answers(const Problem& problem, const Point& null);

}  // namespace sandhopper::diagnose
