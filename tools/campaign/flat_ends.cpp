#include "tools/campaign/flat_ends.hpp"

#include <algorithm>
#include <cmath>

namespace sandhopper {
namespace {

// Consecutive equal samples from row `first` to row `last`.
struct Run {
  std::size_t first, last, samples;
  double value;
};

std::vector<Run> runs_of(std::span<const double> values) {
  std::vector<Run> runs;
  for (std::size_t row = 0; row < values.size(); ++row) {
    if (std::isnan(values[row])) continue;
    if (!runs.empty() && runs.back().value == values[row])
      runs.back().last = row, ++runs.back().samples;
    else
      runs.push_back({row, row, 1, values[row]});
  }
  return runs;
}

}  // namespace

std::vector<bool> stands_at_an_end(std::span<const double> values) {
  std::vector<bool> stands(values.size(), false);
  const auto runs = runs_of(values);
  if (runs.empty()) return stands;
  const auto [low, high] = std::ranges::minmax(runs, {}, &Run::value);
  std::vector<std::size_t> lengths;
  for (const auto& run : runs) lengths.push_back(run.samples);
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::ranges::nth_element(lengths, middle);
  const std::size_t shortest = std::max<std::size_t>(5, 4 * *middle);
  for (const auto& run : runs)
    if (run.samples >= shortest && (run.value == low.value || run.value == high.value))
      std::fill(stands.begin() + static_cast<std::ptrdiff_t>(run.first),
                stands.begin() + static_cast<std::ptrdiff_t>(run.last + 1), true);
  return stands;
}

}  // namespace sandhopper
