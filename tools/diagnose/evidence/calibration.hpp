#pragma once
#include <algorithm>

namespace sandhopper::diagnose {

// Largest probability of a name: the frequency with which names of full posterior mass were right on
// campaigns of four programs that share nothing with this one. Set by tools/benchmark/learn_calibration.mjs.
inline constexpr double kMostOfAName = 0.877;
inline double calibrated(double mass) { return std::clamp(mass, 0.0, kMostOfAName); }

// Largest probability of a name that another form of a named law may stand for: a small effect beside a large
// one, or a name beside something unknown. In the campaigns that set it and `kSmallShare`, 4 of 7 effects
// that explained less than this share of the total were right.
inline constexpr double kMostInDoubt = 0.7;
inline constexpr double kSmallShare = 0.13;
inline double mass_beside(double mass, double share_of_explained) {
  return share_of_explained < kSmallShare ? std::min(mass, kMostInDoubt) : mass;
}

// Largest probability of an effect that is named alone on evidence too weak to name it beside others (p from
// kSignificance to kLevel). Set by hand.
inline constexpr double kMostOfWeak = 0.75;
inline double mass_alone(double mass, bool is_weak) { return is_weak ? std::min(mass, kMostOfWeak) : mass; }

}  // namespace sandhopper::diagnose
