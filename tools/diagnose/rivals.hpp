#pragma once
#include <string>
#include <vector>

#include "tools/diagnose/planned_trials.hpp"
#include "tools/diagnose/posterior.hpp"
#include "tools/diagnose/search.hpp"

namespace sandhopper::diagnose {

// Two explanations of the recordings, each with what is known of its parameters.
struct Rivalry {
  const SetFit* first = nullptr;
  const SetFit* second = nullptr;
  std::string first_name, second_name;  // of the effects in which they differ
};

// The best set against each set that has one effect exchanged for another that explains as much.
std::vector<Rivalry> rivalries(const Problem& problem, const Search& search, const Posterior& belief);

// What a planned trial would say of two explanations.
struct Contest {
  double lambda = 0.0;   // the smaller one of both ways round, over the dispersion
  double settles = 0.0;  // chance that the difference exceeds `apart`
};
Contest contest(const Problem& problem, const PlannedTrials& planned, std::size_t trial,
                const Rivalry& rivalry, double dispersion, double apart);

// Predictions for the rows of a planned trial: by the first, and by the second refitted to look like it.
struct Predictions {
  std::vector<double> first, second;
};
Predictions predictions(const Problem& problem, const PlannedTrials& planned, std::size_t trial,
                        const Rivalry& rivalry);

}  // namespace sandhopper::diagnose
