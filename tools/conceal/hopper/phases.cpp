#include <cmath>

#include "tools/conceal/hopper/world.hpp"

namespace sandhopper::conceal::hopper {
namespace {

// Name of a recorded phase, and of the short phase around its start.
struct Names {
  const char* phase;
  const char* start;
  double before_s, after_s;  // The short phase lasts from this long before the start to this long after it.
};
// In the order of the controller's phases.
constexpr Names kNames[] = {{"flight", "liftoff", 0.010, 0.015},
                            {"compression", "touchdown", 0.015, 0.015},
                            {"extension", "switch", 0.010, 0.015}};

const Names& names_of(double recorded) { return kNames[std::lround(recorded)]; }

}  // namespace

std::vector<std::string> phases(const World&, const Setup&, const TrialRandom&, const Table& recorded) {
  const auto& t_s = recorded.columns.front().values;
  const auto& phase = recorded.find("phase")->values;
  std::vector<std::string> names;
  for (const double value : phase) names.emplace_back(names_of(value).phase);
  // Backwards, so that a row near two changes belongs to the earlier one.
  for (std::size_t change = phase.size(); change-- > 1;) {
    if (phase[change] == phase[change - 1]) continue;
    const auto& now = names_of(phase[change]);
    for (std::size_t i = 0; i < t_s.size(); ++i)
      if (t_s[i] > t_s[change] - now.before_s && t_s[i] < t_s[change] + now.after_s) names[i] = now.start;
  }
  return names;
}

}  // namespace sandhopper::conceal::hopper
