#pragma once
#include <cstddef>

namespace sandhopper::benchmark {

struct Interval {
  double low, high;
};

// 95 % confidence interval of a probability, for `count` successes in `of` trials.
Interval wilson95(std::size_t count, std::size_t of);           // Wilson, J. Am. Stat. Assoc. 22, 1927
Interval clopper_pearson95(std::size_t count, std::size_t of);  // Biometrika 26, 1934; conservative

}  // namespace sandhopper::benchmark
