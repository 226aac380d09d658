#include "tools/diagnose/evidence/posterior.hpp"

#include <algorithm>
#include <cmath>

namespace sandhopper::diagnose {
namespace {

struct Weighed {
  const SetFit* fit = nullptr;
  const UnknownLaw* law = nullptr;  // null: none
  double log_mass = 0.0, mass = 0.0;
};

double deviance_explained(const Search& search) {
  return std::max(0.0, search.null().fit.deviance - search.best().fit.deviance);
}

}  // namespace

std::string port_of(const FreeFamily& family) {
  const auto dot = family.port.find('.');
  return family.sensor || dot == std::string::npos ? family.port : family.port.substr(0, dot);
}

Posterior posterior(const Problem& problem, const Search& search, const std::vector<UnknownLaw>& beside,
                    const std::vector<UnknownLaw>& instead) {
  Posterior out;
  std::vector<Weighed> all;
  for (const auto& [set, fit] : search.sets())
    if (fit.judged && (fit.agreed || set.empty()) &&
        (fit.fit.status != FitStatus::failed || set.empty() || &fit == &search.best()))
      all.push_back({&fit, nullptr, fit.log_mass});
  const auto add_laws = [&](const SetFit& fit, const std::vector<UnknownLaw>& laws) {
    for (const auto& law : laws)
      if (law.agreed) all.push_back({&fit, &law,
                     fit.log_mass + law.log_factor +
                         std::log(kLimits.unknown_expected / static_cast<double>(laws.size()))});
  };
  add_laws(search.best(), beside);
  if (!search.best().set.empty()) add_laws(search.null(), instead);
  const double most = std::ranges::max_element(all, {}, &Weighed::log_mass)->log_mass;
  double total = 0.0;
  for (auto& one : all) total += one.mass = std::exp(one.log_mass - most);
  for (auto& one : all) one.mass /= total;

  const SetFit& best = search.best();
  double without_law = 0.0;
  for (const auto& one : all)
    if (one.law == nullptr && one.fit == &best) without_law = one.mass;
  const Weighed* likeliest = nullptr;
  for (const auto& one : all) {
    if (one.law == nullptr) continue;
    out.unknown += one.mass;
    out.unknown_port[port_of(one.law->family)] += one.mass;
    if (likeliest == nullptr || one.log_mass > likeliest->log_mass) likeliest = &one;
  }
  if (likeliest != nullptr) {
    out.law = *likeliest->law;
    out.alone = likeliest->fit->set.empty();
    const double explained = out.alone ? 0.0 : deviance_explained(search);
    out.share = likeliest->law->gain / std::max(likeliest->law->gain + explained, 1e-300);
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
      if (one.law != nullptr || set.size() != best.set.size() || !std::ranges::includes(set, rest) ||
          one.mass < kLimits.member * without_law)
        continue;
      with += one.mass;
      for (const auto other : set)
        if (std::ranges::find(rest, other) == rest.end()) rivals.emplace_back(-one.mass, other);
    }
    out.probability[candidate] = with;
    std::ranges::sort(rivals);
    for (const auto& rival : rivals) out.alternatives[candidate].push_back(rival.second);
  }
  (void)problem;
  return out;
}

}  // namespace sandhopper::diagnose
