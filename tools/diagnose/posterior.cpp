#include "tools/diagnose/posterior.hpp"

#include <algorithm>
#include <cmath>

namespace sandhopper::diagnose {
namespace {

constexpr double kSameClass = 9.0;        // lambda below which two explanations are one class
constexpr double kRemainderScale = 10.0;  // of remainder that halves every difference
constexpr double kShareOfExplained =
    0.01;  // a difference this small may come from the simulation's own errors

}  // namespace

Posterior posterior(const Problem& problem, const Search& search, double remainder) {
  (void)problem;
  Posterior out;
  const SetFit& best = search.best();
  const double best_score = search.criterion(best);
  const double explained =
      std::max(0.0, search.null().fit.deviance - best.fit.deviance) / search.dispersion();
  const double temperature = 1.0 + remainder / kRemainderScale + kShareOfExplained * explained / kSameClass;
  out.apart = kSameClass * temperature;
  out.apart_per_explained = kShareOfExplained;
  double total = 0.0;
  std::map<std::vector<std::size_t>, double> weight;
  for (const auto& [set, fit] : search.sets()) {
    // A rival need not be needed in every part, but it must not be larger than what it competes with.
    if (fit.fit.status == FitStatus::failed || set.size() > best.set.size()) continue;
    const double difference = search.criterion(fit) - best_score;
    const double w = std::exp(-0.5 * std::max(0.0, difference) / temperature);
    weight[set] = w;
    total += w;
  }
  for (const auto candidate : best.set) {
    double with = 0.0;
    for (const auto& [set, w] : weight)
      if (std::find(set.begin(), set.end(), candidate) != set.end()) with += w;
    out.probability[candidate] = total > 0.0 ? with / total : 0.0;
    auto rest = best.set;
    rest.erase(std::remove(rest.begin(), rest.end(), candidate), rest.end());
    std::vector<std::pair<double, std::size_t>> rivals;
    for (const auto& [set, fit] : search.sets()) {
      if (set.size() != best.set.size() || fit.fit.status == FitStatus::failed) continue;
      if (std::find(set.begin(), set.end(), candidate) != set.end()) continue;
      if (!std::includes(set.begin(), set.end(), rest.begin(), rest.end())) continue;
      const double difference = (fit.fit.deviance - best.fit.deviance) / search.dispersion();
      if (difference > out.apart) continue;
      for (const auto other : set)
        if (std::find(rest.begin(), rest.end(), other) == rest.end()) rivals.emplace_back(difference, other);
    }
    std::sort(rivals.begin(), rivals.end());
    for (const auto& rival : rivals) out.alternatives[candidate].push_back(rival.second);
  }
  return out;
}

}  // namespace sandhopper::diagnose
