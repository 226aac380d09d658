#pragma once
#include <span>
#include <vector>

namespace sandhopper {

// True for each sample of a signal that stands at its smallest or largest value for five samples or more, and
// for four times as long as the signal usually holds one value. A sensor at the end of its range does so, and
// a signal that rests; noise reaches an extreme value by single samples. NaN: no sample, skipped.
std::vector<bool> stands_at_an_end(std::span<const double> values);

}  // namespace sandhopper
