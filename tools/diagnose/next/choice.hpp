#pragma once
#include <cstddef>
#include <vector>

#include "tools/diagnose/answer/diagnosis.hpp"
#include "tools/diagnose/model/reach.hpp"
#include "tools/diagnose/next/planned_trials.hpp"
#include "tools/experiment/parallel.hpp"

namespace sandhopper::diagnose {

// Doublings of information that one unit of cost must give. Set by hand: a larger value prefers usual
// set-ups.
inline constexpr double kLeastGainPerCost = 0.1;

// The trial with the largest worth minus cost (the first of equals). `worth`: without cost, in doublings of
// the information; `all`: the worth of every trial.
struct Choice {
  std::size_t trial = 0;
  double worth = 0.0;
  std::vector<double> all;
};
template <class Worth>
Choice best_of(const PlannedTrials& planned, const Worth& worth) {
  Choice choice;
  choice.all.resize(planned.size());
  parallel_for(planned.size(), [&](std::size_t i) { choice.all[i] = worth(i); });
  double most = -1e300;
  for (std::size_t i = 0; i < planned.size(); ++i)
    if (const double net = choice.all[i] - kLeastGainPerCost * planned[i].cost; net > most) {
      most = net;
      choice.trial = i;
      choice.worth = choice.all[i];
    }
  return choice;
}

// Fills in a trial that is recommended.
void take(const DoableTrial& trial, const char* purpose, NextTrial& next);

// Puts the order before the reason of a recommended trial, and marks a set-up beyond the recorded ones.
void complete(const Reach& reach, NextTrial& next);

}  // namespace sandhopper::diagnose
