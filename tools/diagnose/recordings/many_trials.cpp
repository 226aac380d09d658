#include "tools/diagnose/recordings/many_trials.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <tuple>

namespace sandhopper::diagnose {
namespace {

double energy(const Trial& trial) {
  double sum = 0.0;
  for (const auto& [channel, values] : trial.channels)
    for (const double v : values)
      if (std::isfinite(v)) sum += v * v;
  return sum;
}

}  // namespace

Recordings spread_over(const Recordings& recordings, std::size_t count) {
  const auto& trials = recordings.trials;
  std::vector<std::tuple<std::string, std::map<std::string, double>, std::size_t, double>> keys;
  for (const auto& trial : trials)
    keys.emplace_back(trial.kind, trial.setup, trial.time_s.size(), energy(trial));
  std::vector<std::size_t> order(trials.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(
      order, {}, [&](std::size_t i) -> const auto& { return keys[i]; });
  Recordings some = recordings;
  some.trials.clear();
  some.beliefs.clear();
  const std::size_t taken = std::min(count, trials.size());
  for (std::size_t k = 0; k < taken; ++k) {
    const std::size_t i = order[(2 * k + 1) * trials.size() / (2 * taken)];
    some.trials.push_back(trials[i]);
    some.beliefs.push_back(recordings.beliefs[i]);
  }
  return some;
}

std::vector<Point> carried_over(const Problem& from, const std::vector<Point>& points, const Problem& to,
                                const Point& null) {
  std::vector<Point> carried;
  for (const auto& point : points) {
    Point there = null;
    there.hypothesis = {};
    for (std::size_t e = 0; e < point.hypothesis.candidates.size(); ++e) {
      const auto label = from.candidates[point.hypothesis.candidates[e]].label();
      const auto known = std::ranges::find_if(
          to.candidates, [&](const Candidate& candidate) { return candidate.label() == label; });
      if (known == to.candidates.end()) break;
      auto values = point.hypothesis.values[e];
      for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = std::clamp(values[i], known->parameters[i].low, known->parameters[i].high);
      there.hypothesis.candidates.push_back(static_cast<std::size_t>(known - to.candidates.begin()));
      there.hypothesis.values.push_back(std::move(values));
    }
    if (there.hypothesis.candidates.size() == point.hypothesis.candidates.size())
      carried.push_back(std::move(there));
  }
  return carried;
}

}  // namespace sandhopper::diagnose
