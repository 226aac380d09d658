#pragma once
#include <algorithm>
#include <array>
#include <cstddef>

namespace sandhopper::diagnose {

// The weight that a claim has among all sets that were fitted, as the probability that it is right: a
// monotone map, piecewise linear, frozen. See README for the campaigns it was chosen on.
inline double calibrated(double weight) {
  struct Knot {
    double weight, probability;
  };
  constexpr std::array<Knot, 5> kMap{{{0.0, 0.0}, {0.4, 0.45}, {0.7, 0.7}, {0.95, 0.88}, {1.0, 0.985}}};
  const double w = std::clamp(weight, 0.0, 1.0);
  std::size_t i = 1;
  while (i + 1 < kMap.size() && w > kMap[i].weight) ++i;
  const auto& a = kMap[i - 1];
  const auto& b = kMap[i];
  return a.probability + (b.probability - a.probability) * (w - a.weight) / (b.weight - a.weight);
}

// Beside a large effect a small one may be no more than how the large one's law differs in form: of those
// that explain less than `kSmallShare` of what all explain, on the campaigns named in README 4 of 7 were
// right.
inline constexpr double kSmallShare = 0.13;
inline constexpr double kMostBeside = 0.7;
inline double calibrated_beside(double probability, double share_of_explained) {
  return share_of_explained < kSmallShare ? std::min(probability, kMostBeside) : probability;
}

// What is named alone on evidence that would not do beside others.
inline constexpr double kMostOfWeak = 0.75;

}  // namespace sandhopper::diagnose
