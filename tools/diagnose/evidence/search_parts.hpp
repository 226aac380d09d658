#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "tools/diagnose/evidence/limits.hpp"
#include "tools/diagnose/fit/fit.hpp"

// Helpers shared by the search over sets (search.cpp), its choice (search_choice.cpp) and its judge
// (search_judge.cpp).
namespace sandhopper::diagnose {

// Smallest amplitude that is named, in typical sizes. Set by hand.
inline constexpr double kSmallestOfTypical = 0.08;
// Smallest drop of the deviance that justifies a fit: with a smaller one two sets can be exchanged.
inline const double kWorthAFit = 2.0 * std::log(kLimits.exchangeable);
// Sets whose deviance is behind the best one's by less than this fraction of the explained deviance are
// extended or used as start points. Set by hand: a larger value costs more fits.
inline constexpr double kNearlyAsGood = 0.35;
// The fit of a set is completed if its criterion exceeds the best one by less. Set by hand: a larger value
// costs more fits.
inline constexpr double kRival = 20.0;

// Settings for the first fit of a set.
inline constexpr FitOptions kRough{.max_iterations = 6, .tolerance = 2.0, .refresh = false};
// Settings for the completed fit of a costly plant: 0.5 in each of 12 trials is kWorthAFit.
inline constexpr FitOptions kCostly{.tolerance = 0.5, .own_gain = 0.5};

// Start sizes of effects whose derivative at zero does not lead to them, in typical sizes.
inline constexpr std::array kCommonSizes{0.5, 2.0, -0.5, -2.0};

// The set without one candidate.
inline std::vector<std::size_t> without(std::vector<std::size_t> set, std::size_t candidate) {
  set.erase(std::remove(set.begin(), set.end(), candidate), set.end());
  return set;
}

// Labels of the set's effects for the log.
inline std::string set_text(const Problem& problem, const std::vector<std::size_t>& set) {
  if (set.empty()) return "nothing";
  std::string text;
  for (const auto c : set) text += (text.empty() ? "" : " + ") + problem.candidates[c].label();
  return text;
}

// The largest amplitude of effect `e` of a hypothesis, in typical sizes.
inline double typicals_of(const Problem& problem, const Hypothesis& hypothesis, std::size_t e) {
  const auto& parameters = problem.candidates[hypothesis.candidates[e]].parameters;
  double typicals = 0.0;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (is_amplitude(parameters, i))
      typicals = std::max(typicals, parameters[i].typicals(hypothesis.values[e][i]));
  return typicals;
}

}  // namespace sandhopper::diagnose
