#include "tools/trial/trace/timing.hpp"

#include <algorithm>

namespace sandhopper::trace {

std::int64_t median(std::vector<std::int64_t> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

std::vector<std::int64_t> steps(const std::vector<std::int64_t>& times_ns) {
  std::vector<std::int64_t> out;
  for (std::size_t i = 1; i < times_ns.size(); ++i) out.push_back(times_ns[i] - times_ns[i - 1]);
  return out;
}

}  // namespace sandhopper::trace
