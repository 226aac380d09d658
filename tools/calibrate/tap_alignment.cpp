#include "tools/calibrate/tap_alignment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sandhopper::calibrate {
namespace {

constexpr std::size_t kFewestTaps = 5;

// Number of taps of `one`, moved by `offset_s`, that lie within the time of `other`, with and without a
// partner there.
struct Counted {
  std::size_t matched = 0, unmatched = 0;
};
Counted count(const TapTimes& one, double offset_s, const TapTimes& other) {
  Counted out;
  for (const double tap_s : one.tap_s) {
    const double at_s = tap_s + offset_s;
    const bool found =
        std::ranges::any_of(other.tap_s, [&](double t) { return std::abs(t - at_s) < kSameTap_s; });
    if (found)
      ++out.matched;
    else if (at_s > other.begin_s + kSameTap_s && at_s < other.end_s - kSameTap_s)
      ++out.unmatched;
  }
  return out;
}

bool better(const TapAlignment& a, const TapAlignment& b) {
  return a.matched != b.matched ? a.matched > b.matched : a.unmatched < b.unmatched;
}

}  // namespace

std::vector<TapAlignment> tap_alignments(const TapTimes& ours, const TapTimes& theirs) {
  std::vector<TapAlignment> all;
  for (const double here : ours.tap_s)
    for (const double there : theirs.tap_s) {
      const double offset_s = here - there;
      const auto forth = count(theirs, offset_s, ours), back = count(ours, -offset_s, theirs);
      if (forth.matched >= kFewestTaps && 2 * forth.matched > theirs.tap_s.size())
        all.push_back({offset_s, forth.matched, forth.unmatched + back.unmatched});
    }
  std::ranges::stable_sort(all, better);
  std::vector<TapAlignment> out;
  for (const auto& alignment : all)
    if (std::ranges::none_of(out, [&](const TapAlignment& a) {
          return std::abs(a.offset_s - alignment.offset_s) < 2.0 * kSameTap_s;
        }))
      out.push_back(alignment);
  return out;
}

std::vector<TapAlignment> rivals_of_first(const std::vector<TapAlignment>& alignments) {
  std::vector<TapAlignment> out;
  for (std::size_t i = 1; i < alignments.size(); ++i) {
    const std::size_t allowed = alignments[0].unmatched > 0 ? alignments[0].unmatched + 1 : 0;
    if (alignments[i].unmatched <= allowed) out.push_back(alignments[i]);
  }
  return out;
}

Refusal ambiguous_alignment(const std::string& name, const TapAlignment& first,
                            const std::vector<TapAlignment>& rivals) {
  const auto shift = [](const TapAlignment& a) {
    return fmt::format("t_recording = t {} {:.3f} s ({} taps match, {} missing)",
                       a.offset_s < 0.0 ? "-" : "+", std::abs(a.offset_s), a.matched, a.unmatched);
  };
  constexpr std::size_t kShown = 3;
  std::string text = shift(first);
  for (std::size_t i = 0; i < std::min(rivals.size(), kShown); ++i) text += ", or " + shift(rivals[i]);
  if (rivals.size() > kShown) text += fmt::format(", or {} more", rivals.size() - kShown);
  return {
      "alignment_ambiguous",
      fmt::format("the taps of {} come evenly and fit ours at {} shifts: {}", name, rivals.size() + 1, text),
      "tap again at uneven intervals (0.5 s, 0.9 s, 0.6 s, 1.1 s, ...), hard enough for both recorders, and "
      "start both 2 s before the first tap and stop them 2 s after the last"};
}

}  // namespace sandhopper::calibrate
