#pragma once
#include <array>

namespace sandhopper::diagnose {

// Priors of the evidence, which is computed beside the present answer and printed with --search. It decides
// nothing yet.
struct Limits {
  double effects_expected = 1.0;  // how many of the list are missing, on average
  double unknown_expected = 0.2;  // and how many that are on no list
  double size_spread = 1.0;       // standard deviation of ln(size / typical)

  // Model error of effects, standard deviations: not learned yet.
  double form = 0.1;            // of an effect's own signature, smooth in time, different in every trial
  double size_of_trial = 0.05;  // of an effect's size between trials
  // Scales of an unknown law, in those of its port; each as likely as the next.
  std::array<double, 3> unknown_sizes{0.3, 1.0, 3.0};
  // Times the learned scale that repeatable model error may have in one campaign, half-normal.
  std::array<double, 5> repeatable_sizes{0.5, 1.0, 2.0, 3.0, 4.0};
};
inline constexpr Limits kLimits{};

}  // namespace sandhopper::diagnose
