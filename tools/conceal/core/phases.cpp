#include "tools/conceal/core/phases.hpp"

namespace sandhopper::conceal {

std::vector<std::string> thirds_of_time(const Table& recorded) {
  std::vector<std::string> phases;
  const auto& t_s = recorded.columns.front().values;
  for (const double now_s : t_s) {
    const double share = (now_s - t_s.front()) / (t_s.back() - t_s.front());
    phases.emplace_back(share < 1.0 / 3.0 ? "early" : share < 2.0 / 3.0 ? "middle" : "late");
  }
  return phases;
}

}  // namespace sandhopper::conceal
