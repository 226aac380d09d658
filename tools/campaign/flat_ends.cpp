#include "tools/campaign/flat_ends.hpp"

#include <algorithm>

#include "tools/campaign/equal_runs.hpp"

namespace sandhopper {
std::vector<bool> stands_at_an_end(std::span<const double> values) {
  std::vector<bool> stands(values.size(), false);
  const auto runs = equal_runs(values);
  if (runs.empty()) return stands;
  const auto [low, high] = std::ranges::minmax(runs, {}, &EqualRun::value);
  std::vector<std::size_t> lengths;
  for (const auto& run : runs) lengths.push_back(run.samples);
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::ranges::nth_element(lengths, middle);
  const std::size_t shortest = std::max<std::size_t>(5, 4 * *middle);
  for (const auto& run : runs)
    if (run.samples >= shortest && (run.value == low.value || run.value == high.value))
      std::fill(stands.begin() + static_cast<std::ptrdiff_t>(run.first_row),
                stands.begin() + static_cast<std::ptrdiff_t>(run.last_row + 1), true);
  return stands;
}

}  // namespace sandhopper
