#include "tools/diagnose/evidence/posterior.hpp"

#include <algorithm>
#include <cmath>

#include "tools/diagnose/discrepancy/overlap.hpp"
#include "tools/diagnose/evidence/limits.hpp"
#include "tools/diagnose/evidence/log_evidence.hpp"

namespace sandhopper::diagnose {
namespace {

// Held-out gain of a free law that adds 1 to the temperature. Set by hand: a smaller value makes
// probabilities of names beside an unexplained rest more equal.
constexpr double kRemainderScale = 10.0;
// Simulation errors, and laws of another form, can change the explained deviance by this fraction. It adds to
// the temperature, so smaller differences between sets count less. Both set by hand.
constexpr double kShareOfExplained = 2e-4;
constexpr double kShareOfForm = 0.02;  // The same, relative to the plant's form error.

// Weight of each fitted set, relative to the best one.
std::map<std::vector<std::size_t>, double> weights(const Problem& problem, const Search& search,
                                                   double temperature) {
  std::map<std::vector<std::size_t>, double> weight;
  for (const auto& [set, fit] : search.sets()) {
    // A rival may hold an effect it does not need, but it must not have more effects than the best set.
    if (fit.fit.status == FitStatus::failed || fit.refused || set.size() > search.best().set.size()) continue;
    // The temperature applies to the evidence of the recordings, not to statements of the user.
    const double stated =
        log_prior_of_statements(problem, set) - log_prior_of_statements(problem, search.best().set);
    const double difference = search.criterion(fit) - search.criterion(search.best()) + 2.0 * stated;
    weight[set] = std::exp(-0.5 * std::max(0.0, difference) / temperature + stated);
  }
  return weight;
}

}  // namespace

double share_in_doubt(double form_error) { return std::max(kShareOfExplained, kShareOfForm * form_error); }

double temperature_with(double remainder) { return 1.0 + remainder / kRemainderScale; }

Posterior posterior(const Problem& problem, const Search& search, double remainder) {
  Posterior out;
  const double differs = share_in_doubt(problem.plant->form_error());
  const SetFit& best = search.best();
  const double explained = with_form_unnoticed(problem, search.null().fit.deviance - best.fit.deviance);
  const double at_least = temperature_with(remainder);
  const double temperature = at_least + differs * explained / search.dispersion();
  out.apart = 2.0 * std::log(kLimits.exchangeable) * temperature;
  out.apart_per_explained = 2.0 * std::log(kLimits.exchangeable) * differs;
  for (std::size_t e = 0; e < best.fit.point.hypothesis.candidates.size(); ++e) {
    const auto candidate = best.fit.point.hypothesis.candidates[e];
    auto rest = best.set;
    std::erase(rest, candidate);
    const auto others = search.sets().find(rest);
    // The other effects stay when this one is exchanged. Their form counts only where this one acts.
    const double where_it_acts = others == search.sets().end() || rest.empty()
                                     ? explained
                                     : std::min(explained, others->second.fit.deviance - best.fit.deviance +
                                                               shown_by_others(problem, best.fit.point, e));
    const auto weight = weights(problem, search, at_least + differs * where_it_acts / search.dispersion());
    double total = 0.0;
    for (const auto& [set, w] : weight) total += w;
    // A name joins the class if it explains something that the other effects leave.
    const double without_any = others == search.sets().end() ? 1e300 : search.criterion(others->second);
    std::vector<std::pair<double, std::size_t>> rivals;
    double with = 0.0;
    for (const auto& [set, w] : weight) {
      if (std::find(set.begin(), set.end(), candidate) != set.end()) {
        with += w;
        continue;
      }
      if (set.size() != best.set.size() || !std::includes(set.begin(), set.end(), rest.begin(), rest.end()))
        continue;
      if (!can_be_exchanged(w)) continue;
      with += w;
      if (search.criterion(search.sets().at(set)) > without_any) continue;
      for (const auto other : set)
        if (std::find(rest.begin(), rest.end(), other) == rest.end()) rivals.emplace_back(-w, other);
    }
    out.mass[candidate] = total > 0.0 ? with / total : 0.0;
    std::sort(rivals.begin(), rivals.end());
    for (const auto& rival : rivals) out.alternatives[candidate].push_back(rival.second);
  }
  return out;
}

}  // namespace sandhopper::diagnose
