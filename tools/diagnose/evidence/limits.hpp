#pragma once
#include <array>

namespace sandhopper::diagnose {

// Priors of the evidence. The answer uses them where it judges if one effect is needed beside others
// (`form_error`) and where it chooses which effect to name alone (`name_likeliest`).
struct Limits {
  // Ratio of probabilities up to which two sets can be exchanged: their names form a class.
  double exchangeable = 20.0;
  double effects_expected = 1.0;  // Prior mean of the number of listed effects that are missing.
  double unknown_expected = 0.2;  // Prior mean of the number of missing effects that are not listed.
  // Prior probability that a statement of [known_to] is wrong: an effect that contradicts one costs this
  // much.
  double statement_wrong = 0.01;
  double size_spread = 1.0;  // Standard deviation of ln(size / typical).

  // Standard deviations of the model error of an effect. Guessed, not learnt from campaigns.
  double form = 0.1;  // Relative to the effect's signature: smooth in time, independent between trials.
  double size_of_trial = 0.05;  // Relative scatter of the effect's size between trials.
  // How large such errors are is not known: these shares of both are equally probable. They are equally far
  // apart in the logarithm, the usual prior of a scale (Jeffreys). The smallest one is hardly an error.
  std::array<double, 7> form_shares{0.001, 0.00316, 0.01, 0.0316, 0.1, 0.316, 1.0};
  // Standard deviations of an unknown law, in the scale of its port; equally probable.
  std::array<double, 3> unknown_sizes{0.3, 1.0, 3.0};
  // Tried ratios of a repeatable model error in this campaign to its learnt scale; half-normal prior.
  std::array<double, 5> repeatable_sizes{0.5, 1.0, 2.0, 3.0, 4.0};
};
inline constexpr Limits kLimits{};

// True if a set stays in question that is so many times as probable as the best one (at most 1).
inline bool can_be_exchanged(double ratio) { return ratio * kLimits.exchangeable >= 1.0; }

}  // namespace sandhopper::diagnose
