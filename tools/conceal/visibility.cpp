#include "tools/conceal/visibility.hpp"

#include <algorithm>
#include <map>

#include "tools/conceal/core/difference.hpp"

namespace sandhopper::conceal {
namespace {

constexpr std::size_t kTrials = 6;  // Enough trials to include every kind of set-up.

void add_difference(std::map<std::string, MeanSquare>& sums, const Table& a, const Table& b) {
  for_each_difference(a, b, [&](const std::string& channel, std::size_t, double d) { sums[channel].add(d); });
}

}  // namespace

Visibility difference(const Case& c, const std::vector<HiddenEffect>& one,
                      const std::vector<HiddenEffect>& other) {
  const auto first = build(c, one), second = build(c, other), plain = build(c, {});
  std::map<std::string, MeanSquare> effect, repeat;
  const auto stride = std::max<std::size_t>(1, c.setups.size() / kTrials);
  for (std::size_t i = 0; i < c.setups.size(); i += stride) {
    const auto trial = c.recording.stream("trial", i);
    const auto without = record(c, *plain, c.setups[i], trial);
    const auto reference = other.empty() ? without : record(c, *second, c.setups[i], trial);
    add_difference(effect, reference, record(c, *first, c.setups[i], trial));
    add_difference(repeat, without, record(c, *plain, c.setups[i], c.recording.stream("repeat", i)));
  }
  Visibility most;
  for (const auto& [channel, sum] : effect) {
    const double floor = repeat[channel].rms();
    if (floor <= 0.0) continue;
    const double ratio = sum.rms() / floor;
    if (ratio > most.ratio) most = {channel, ratio};
  }
  return most;
}

Visibility visibility(const Case& c, const std::vector<HiddenEffect>& hidden) {
  return difference(c, hidden, {});
}

}  // namespace sandhopper::conceal
