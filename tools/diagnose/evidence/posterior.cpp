#include "tools/diagnose/evidence/posterior.hpp"

#include <algorithm>
#include <cmath>

namespace sandhopper::diagnose {
namespace {

struct Weighed {
  const std::vector<std::size_t>* set = nullptr;
  const LawBeside* law = nullptr;
  double log_mass = 0.0, mass = 0.0;
};

}  // namespace

std::string port_of(const std::string& port, bool sensor) {
  const auto dot = port.find('.');
  return sensor || dot == std::string::npos ? port : port.substr(0, dot);
}

Posterior posterior(const Problem& problem, const Search& search, const std::vector<LawBeside>& beside) {
  (void)problem;
  Posterior out;
  std::vector<Weighed> all;
  for (const auto& [set, fit] : search.sets()) {
    if (!fit.judged || (fit.fit.status == FitStatus::failed && !set.empty() && &fit != &search.best()) ||
        !search.trials_agree(fit))
      continue;
    all.push_back({&set, nullptr, fit.log_mass});
  }
  for (const auto& law : beside)
    if (law.agreed && search.trials_agree(search.sets().at(law.set))) all.push_back({&law.set, &law, law.log_mass});
  const double most = std::ranges::max_element(all, {}, &Weighed::log_mass)->log_mass;
  double total = 0.0;
  for (auto& one : all) total += one.mass = std::exp(one.log_mass - most);
  for (auto& one : all) one.mass /= total;
  std::map<std::vector<std::size_t>, double> of_set;
  for (const auto& one : all) of_set[*one.set] += one.mass;
  // Names count among themselves, unless nothing is missing or they are far less likely than a law on no list.
  double nothing = 0.0, named = 0.0;
  for (const auto& one : all) {
    if (!one.set->empty()) named += one.mass;
    else if (one.law == nullptr) nothing += one.mass;
  }
  if (named >= kLimits.member && named > nothing) {
    double most_of_set = 0.0;
    for (const auto& [set, mass] : of_set)
      if (!set.empty() && mass > most_of_set) most_of_set = mass, out.best = set;
  }
  const Weighed* likeliest = nullptr;
  for (const auto& one : all) {
    if (one.law == nullptr) continue;
    const auto& family = one.law->law.family;
    out.unknown += one.mass;
    out.unknown_port[port_of(family.port, family.sensor)] += one.mass;
    if (likeliest == nullptr || one.log_mass > likeliest->log_mass) likeliest = &one;
  }
  if (likeliest != nullptr) {
    out.law = *likeliest->law;
    out.alone = likeliest->set->empty();
    const double explained = std::max(0.0, search.null().fit.deviance - out.law->fit.deviance);
    out.share = std::clamp(out.law->law.gain / std::max(explained, 1e-300), 0.0, 1.0);
  }
  for (const auto candidate : out.best) {
    auto rest = out.best;
    std::erase(rest, candidate);
    double with = 0.0;
    std::map<std::size_t, double> rivals;
    for (const auto& [set, mass] : of_set) {
      if (std::ranges::find(set, candidate) != set.end()) {
        with += mass;
        continue;
      }
      if (set.size() != out.best.size() || !std::ranges::includes(set, rest) ||
          mass < kLimits.member * of_set[out.best])
        continue;
      with += mass;
      for (const auto other : set)
        if (std::ranges::find(rest, other) == rest.end()) rivals[other] += mass;
    }
    out.probability[candidate] = with / named;
    std::vector<std::pair<double, std::size_t>> order;
    for (const auto& [other, mass] : rivals) order.emplace_back(-mass, other);
    std::ranges::sort(order);
    for (const auto& [mass, other] : order) out.alternatives[candidate].push_back(other);
  }
  return out;
}

}  // namespace sandhopper::diagnose
