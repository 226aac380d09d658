#pragma once
#include <algorithm>
#include <array>
#include <cstddef>

namespace sandhopper::diagnose {

// Maps the posterior weight of a claim (its share among all fitted sets) to the probability that it is right.
// The map is monotone, piecewise linear and fixed.
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

// A small effect beside a large one may only correct the form of the large one's law. Therefore an effect
// that explains less than `kSmallShare` of the total gets a probability of at most `kMostBeside`: in the
// campaigns that set these two numbers, 4 of 7 such effects were right.
inline constexpr double kSmallShare = 0.13;
inline constexpr double kMostBeside = 0.7;
inline double mass_beside(double mass, double share_of_explained) {
  return share_of_explained < kSmallShare ? std::min(mass, kMostBeside) : mass;
}

// Largest probability of an effect that is named alone on evidence too weak to name it beside others.
inline constexpr double kMostOfWeak = 0.75;

}  // namespace sandhopper::diagnose
