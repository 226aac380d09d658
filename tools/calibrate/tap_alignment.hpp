#pragma once
#include <string>
#include <vector>

#include "tools/calibrate/outcome.hpp"

namespace sandhopper::calibrate {

// Taps of two recordings that lie nearer to each other are one tap.
inline constexpr double kSameTap_s = 0.01;

// Times of taps in one recording, and the time between which it recorded.
struct TapTimes {
  std::vector<double> tap_s;
  double begin_s = 0.0;
  double end_s = 0.0;
};

// An offset at which foreign taps coincide with ours: t_ours = t_theirs + offset_s.
struct TapAlignment {
  double offset_s = 0.0;
  std::size_t matched = 0;  // taps that both recordings show, within 10 ms
  // Taps that one recording shows while the other one recorded and shows none. A tap outside the other
  // recording's time is none of these.
  std::size_t unmatched = 0;
};

// All offsets at which at least five taps and more than half of the foreign ones match; those with most
// matches first, of equal ones that with fewest unmatched taps. Offsets closer than 20 ms are one.
std::vector<TapAlignment> tap_alignments(const TapTimes& ours, const TapTimes& theirs);

// Alignments that explain the taps nearly as well as the first one. If no tap of the first is unmatched, the
// recordings miss no taps, and only alignments without unmatched taps count. If some are, a recording misses
// taps, and one more may be missing.
std::vector<TapAlignment> rivals_of_first(const std::vector<TapAlignment>& alignments);

// Refusal "alignment_ambiguous" with all offsets that fit. `name` is that of the foreign recording.
Refusal ambiguous_alignment(const std::string& name, const TapAlignment& first,
                            const std::vector<TapAlignment>& rivals);

}  // namespace sandhopper::calibrate
