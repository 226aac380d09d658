#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace sandhopper {

// Consecutive equal samples of a channel. Rows without a sample (NaN) in between are skipped.
struct EqualRun {
  std::size_t first_row, last_row;
  std::size_t samples;
  double value;
};
std::vector<EqualRun> equal_runs(std::span<const double> values);

}  // namespace sandhopper
