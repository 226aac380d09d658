#include "tools/campaign/equal_runs.hpp"

#include <cmath>

namespace sandhopper {

std::vector<EqualRun> equal_runs(std::span<const double> values) {
  std::vector<EqualRun> runs;
  for (std::size_t row = 0; row < values.size(); ++row) {
    if (std::isnan(values[row])) continue;
    if (runs.empty() || runs.back().value != values[row]) runs.push_back({row, row, 0, values[row]});
    runs.back().last_row = row;
    ++runs.back().samples;
  }
  return runs;
}

}  // namespace sandhopper
