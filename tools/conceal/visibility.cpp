#include "tools/conceal/visibility.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace sandhopper::conceal {
namespace {

constexpr std::size_t kTrials = 6;  // Enough trials to include every kind of set-up.

struct Sum {
  double squares = 0.0;
  double count = 0.0;
};

void add_difference(std::map<std::string, Sum>& sums, const Table& a, const Table& b) {
  for (const auto& column : a.columns) {
    const auto* other = b.find(column.name);
    if (!other || column.name == "t_s") continue;
    auto& sum = sums[column.name];
    const auto rows = std::min(column.values.size(), other->values.size());
    for (std::size_t i = 0; i < rows; ++i) {
      const double d = column.values[i] - other->values[i];
      if (!std::isnan(d)) sum.squares += d * d, sum.count += 1.0;
    }
  }
}

}  // namespace

Visibility difference(const Case& c, const std::vector<HiddenEffect>& one,
                      const std::vector<HiddenEffect>& other) {
  const auto first = build(c, one), second = build(c, other), plain = build(c, {});
  std::map<std::string, Sum> effect, repeat;
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
    const auto& floor = repeat[channel];
    if (sum.count < 1.0 || floor.squares <= 0.0) continue;
    const double ratio = std::sqrt(sum.squares / sum.count / (floor.squares / floor.count));
    if (ratio > most.ratio) most = {channel, ratio};
  }
  return most;
}

Visibility visibility(const Case& c, const std::vector<HiddenEffect>& hidden) {
  return difference(c, hidden, {});
}

}  // namespace sandhopper::conceal
