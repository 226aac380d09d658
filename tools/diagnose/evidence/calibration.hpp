#pragma once
#include <algorithm>
#include <array>
#include <cstddef>

namespace sandhopper::diagnose {

// Maps the posterior mass of a named effect (its share among all fitted sets) to the frequency with which such
// names were right: isotonic regression on the claims of four programs that share nothing with this one, linear
// between the knots. Set by tools/benchmark/learn_calibration.mjs.
inline double calibrated(double mass) {
  struct Knot {
    double mass, probability;
  };
  constexpr std::array<Knot, 4> kMap{{{0.0, 0.0}, {0.159, 0.045}, {0.754, 0.588}, {1.000, 0.877}}};
  const double m = std::clamp(mass, 0.0, 1.0);
  std::size_t i = 1;
  while (i + 1 < kMap.size() && m > kMap[i].mass) ++i;
  const auto& a = kMap[i - 1];
  const auto& b = kMap[i];
  return a.probability + (b.probability - a.probability) * (m - a.mass) / (b.mass - a.mass);
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
