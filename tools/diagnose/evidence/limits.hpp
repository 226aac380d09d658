#pragma once
#include <array>

namespace sandhopper::diagnose {

// Every number that decides a verdict. Priors are beliefs; scales of model error are learned (README).
struct Limits {
  // Beforehand.
  double effects_expected = 1.0;  // how many of the list are missing, on average
  double unknown_expected = 0.2;  // and how many that are on no list
  double size_spread = 1.0;       // standard deviation of ln(size / typical)

  // Model error of effects, standard deviations: not learned yet.
  double form = 0.1;            // of an effect's own signature: along a coordinate, and in time trial by trial
  double size_of_trial = 0.05;  // of an effect's size between trials
  // Scales of an unknown law, in those of its port; each as likely as the next.
  std::array<double, 5> unknown_sizes{0.03, 0.1, 0.3, 1.0, 3.0};
  // Times the learned scale that model error may have in one campaign, half-normal.
  std::array<double, 5> error_sizes{0.5, 1.0, 2.0, 3.0, 4.0};
  // The same of forces of one trial alone, half-Cauchy.
  std::array<double, 8> force_sizes{0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0};

  // What the answer says.
  double named = 0.5;            // a name with less is not told
  double member = 0.05;          // of the likeliest's mass: who has less is no member of its class
  double most_of_gap = 0.5;      // what is unknown and closes less of it stands beside a name
  double beside_unknown = 0.7;   // most of a name beside something unknown
  double trials_agree = 0.05;    // p that trials come nearer by chance
};
inline constexpr Limits kLimits{};

}  // namespace sandhopper::diagnose
