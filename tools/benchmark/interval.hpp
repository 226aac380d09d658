#pragma once
#include <cstddef>

namespace sandhopper::benchmark {

struct Interval {
  double low, high;
};

// 95 % interval of a share seen `count` times of `of`.
Interval wilson95(std::size_t count, std::size_t of);           // Wilson, J. Am. Stat. Assoc. 22, 1927
Interval clopper_pearson95(std::size_t count, std::size_t of);  // Biometrika 26, 1934; never too narrow

}  // namespace sandhopper::benchmark
