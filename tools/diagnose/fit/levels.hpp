#pragma once

// Significance levels that all tests of the diagnosis share.
namespace sandhopper::diagnose {

// Level of an interval (95 %), and of a test whose claim another test must confirm.
inline constexpr double kLevel = 0.05;
// Family-wise level of a claim.
inline constexpr double kSignificance = 0.01;
// Level of a claim that one test must bear alone: as if two independent tests had both reached kSignificance.
inline constexpr double kTwofold = kSignificance * kSignificance;
// Level of a claim for which no other test is needed.
inline constexpr double kBeyondDoubt = kTwofold * kTwofold;
// Probability from which something is more likely than not; also a share that is the larger part.
inline constexpr double kLikelierThanNot = 0.5;

}  // namespace sandhopper::diagnose
