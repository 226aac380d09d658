#include "tools/diagnose/evidence/posterior.hpp"

#include <algorithm>
#include <cmath>

namespace sandhopper::diagnose {
namespace {

struct Weighed {
  const SetFit* fit = nullptr;
  bool unknown = false;  // with the unknown law of its evidence
  double log_mass = 0.0, mass = 0.0;
};

double deviance_explained(const Search& search) {
  return std::max(0.0, search.null().fit.deviance - search.best().fit.deviance);
}

}  // namespace

std::string port_of(const std::string& port, bool sensor) {
  const auto dot = port.find('.');
  return sensor || dot == std::string::npos ? port : port.substr(0, dot);
}

Posterior posterior(const Problem& problem, const Search& search, const std::vector<UnknownLaw>& beside) {
  Posterior out;
  const auto& groups = problem.repeatable_error.groups;
  // An unknown law that trials do not agree on is none.
  const auto agreed = [&](std::size_t group) {
    return std::ranges::any_of(beside, [&](const UnknownLaw& law) {
      return law.agreed && law.family.port == groups[group].port && law.family.variable == groups[group].variable;
    });
  };
  std::vector<Weighed> all;
  for (const auto& [set, fit] : search.sets()) {
    if (!fit.judged || !(fit.agreed || set.empty()) ||
        (fit.fit.status == FitStatus::failed && !set.empty() && &fit != &search.best()))
      continue;
    all.push_back({&fit, false, fit.log_mass});
    if (std::isfinite(fit.unknown_log_mass) && agreed(fit.evidence.unknown))
      all.push_back({&fit, true, fit.unknown_log_mass});
  }
  const double most = std::ranges::max_element(all, {}, &Weighed::log_mass)->log_mass;
  double total = 0.0;
  for (auto& one : all) total += one.mass = std::exp(one.log_mass - most);
  for (auto& one : all) one.mass /= total;

  const SetFit& best = search.best();
  std::map<const SetFit*, double> of_set;
  for (const auto& one : all) of_set[one.fit] += one.mass;
  const Weighed* likeliest = nullptr;
  for (const auto& one : all) {
    if (!one.unknown) continue;
    const auto& group = groups[one.fit->evidence.unknown];
    out.unknown += one.mass;
    out.unknown_port[port_of(group.port, group.sensor)] += one.mass;
    if (likeliest == nullptr || one.log_mass > likeliest->log_mass) likeliest = &one;
  }
  if (likeliest != nullptr) {
    const auto& group = groups[likeliest->fit->evidence.unknown];
    out.law = *std::ranges::find_if(beside, [&](const UnknownLaw& law) {
      return law.family.port == group.port && law.family.variable == group.variable;
    });
    out.alone = likeliest->fit->set.empty();
    const double explained = out.alone ? 0.0 : deviance_explained(search);
    out.share = out.law->gain / std::max(out.law->gain + explained, 1e-300);
  }
  for (const auto candidate : best.set) {
    auto rest = best.set;
    std::erase(rest, candidate);
    double with = 0.0;
    std::vector<std::pair<double, std::size_t>> rivals;
    for (const auto& one : all) {
      const auto& set = one.fit->set;
      if (std::ranges::find(set, candidate) != set.end()) {
        with += one.mass;
        continue;
      }
      if (set.size() != best.set.size() || !std::ranges::includes(set, rest) ||
          of_set[one.fit] < kLimits.member * of_set[&best])
        continue;
      with += one.mass;
      if (one.unknown) continue;
      for (const auto other : set)
        if (std::ranges::find(rest, other) == rest.end()) rivals.emplace_back(-one.mass, other);
    }
    out.probability[candidate] = with;
    std::ranges::sort(rivals);
    for (const auto& rival : rivals) out.alternatives[candidate].push_back(rival.second);
  }
  return out;
}

}  // namespace sandhopper::diagnose
