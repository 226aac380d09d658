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

// Largest probability of a name that another form of a named law may stand for: a small effect beside a large
// one, or a name beside something unknown. In the campaigns that set it and `kSmallShare`, 4 of 7 effects
// that explained less than this share of the total were right.
inline constexpr double kMostInDoubt = 0.7;
inline constexpr double kSmallShare = 0.13;
inline double mass_beside(double mass, double share_of_explained) {
  return share_of_explained < kSmallShare ? std::min(mass, kMostInDoubt) : mass;
}

// Largest probability of an effect that is named alone on evidence too weak to name it beside others.
inline constexpr double kMostOfWeak = 0.75;
inline double mass_alone(double mass, bool is_weak) { return is_weak ? std::min(mass, kMostOfWeak) : mass; }

}  // namespace sandhopper::diagnose
