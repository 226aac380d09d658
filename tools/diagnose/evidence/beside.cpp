#include "tools/diagnose/evidence/beside.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "tools/diagnose/evidence/bagged.hpp"
#include "tools/diagnose/evidence/form_error.hpp"
#include "tools/diagnose/evidence/log_evidence.hpp"
#include "tools/diagnose/evidence/search_parts.hpp"
#include "tools/diagnose/evidence/unknown_law.hpp"

namespace sandhopper::diagnose {
namespace {

// Number of sets whose evidence is computed: those with the smallest criterion.
constexpr std::size_t kWeighed = 8;
constexpr std::size_t kAnySize = std::numeric_limits<std::size_t>::max();
constexpr double kNoEvidence = -1e300;
constexpr std::size_t kLawsWeighed = 3;  // Number of unknown laws listed with one set.

struct WeighedAnswer {
  std::string what;
  double log_mass = 0.0;
};

// The complete fits with the smallest criterion, of at most so many effects.
std::vector<const SetFit*> nearest_fits(const Search& search, std::size_t most_effects) {
  std::vector<const SetFit*> order;
  for (const auto& [set, fit] : search.sets())
    if (!fit.rough && fit.fit.status != FitStatus::failed && set.size() <= most_effects)
      order.push_back(&fit);
  std::ranges::sort(order, {}, [&](const SetFit* fit) { return search.criterion(*fit); });
  if (order.size() > kWeighed) order.resize(kWeighed);
  return order;
}

// The same, and always the null and the best set.
std::vector<const SetFit*> nearest(const Search& search, std::size_t most_effects) {
  auto order = nearest_fits(search, most_effects);
  for (const SetFit* always : {&search.null(), &search.best()})
    if (std::ranges::find(order, always) == order.end()) order.push_back(always);
  return order;
}

LogEvidence evidence_of(const Problem& problem, const SetFit& fit) {
  return log_evidence(problem, fit.fit, linearised_at(problem, fit.fit.point));
}

// kNoEvidence if it cannot be computed, e.g. because a derivative is not finite.
double log_mass_of(const Problem& problem, const SetFit& fit, const LogEvidence& evidence) {
  const double log_mass = evidence.value + log_prior(problem, fit.set);
  return std::isfinite(log_mass) ? log_mass : kNoEvidence;
}

}  // namespace

void name_likeliest(Problem& problem, Search& search, std::vector<std::string>& log) {
  const auto is_law = [&](const SetFit* fit) { return !laws_of(problem, fit->fit.point.hypothesis).empty(); };
  if (search.best().set.size() != 1 || !is_law(&search.best())) return;
  problem.repeatable_error = {};
  const std::string before = set_text(problem, search.best().set);
  auto fits = nearest(search, 1);
  std::erase_if(fits, [&](const SetFit* fit) { return !is_law(fit); });
  const auto masses = bagged_masses(problem, fits);
  std::vector<std::pair<double, const SetFit*>> order;
  double of_best = 0.0;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    order.emplace_back(masses[i], fits[i]);
    if (fits[i] == &search.best()) of_best = masses[i];
  }
  std::ranges::sort(order, std::greater<>{}, [](const auto& one) { return one.first; });
  for (const auto& [mass, fit] : order) {
    if (can_be_exchanged(of_best / mass)) return;
    if (!search.name(fit->set)) continue;
    // Laws that fit as well stay in question: between them only the widths of priors decide.
    for (const auto& [other, rival] : order)
      if (!can_be_exchanged(other / mass) && std::abs(rival->fit.deviance - fit->fit.deviance) > kWorthAFit)
        search.refuse(rival->set);
    log.push_back(fmt::format("{} is more probable than {}: {:.3g} and {:.3g}", set_text(problem, fit->set),
                              before, mass, of_best));
    return;
  }
}

std::optional<LikelyLaw> likeliest_law(Problem& problem, const Search& search) {
  problem.repeatable_error = repeatable_error(problem, signatures_at(problem, search.null().fit.point));
  std::optional<LikelyLaw> likeliest;
  double most = kNoEvidence;
  for (const SetFit* fit : {&search.best(), &search.null()}) {
    const auto evidence = evidence_of(problem, *fit);
    const auto laws = unknown_laws(problem, fit->fit.point, evidence.times);
    if (laws.empty()) continue;
    const double log_mass = log_mass_of(problem, *fit, evidence) + laws.front().log_factor;
    if (!(log_mass > most)) continue;
    most = log_mass;
    likeliest = {laws.front().family, fit == &search.null()};
  }
  problem.repeatable_error = {};
  return likeliest;
}

void limit_by_evidence(Problem& problem, const Search& search, Posterior& belief,
                       std::vector<std::string>& log) {
  auto close = nearest_fits(search, kAnySize);
  const double limit = search.criterion(search.best()) + belief.apart;
  std::erase_if(close, [&](const SetFit* fit) {
    return fit == &search.best() || fit->refused || search.criterion(*fit) > limit;
  });
  if (close.empty()) return;
  close.push_back(&search.best());
  problem.repeatable_error = {};
  const auto masses = bagged_masses(problem, close);
  for (auto& [candidate, mass] : belief.mass) {
    std::vector<std::size_t> names{candidate};
    if (const auto others = belief.alternatives.find(candidate); others != belief.alternatives.end())
      names.insert(names.end(), others->second.begin(), others->second.end());
    double with = 0.0;
    for (std::size_t i = 0; i < close.size(); ++i)
      if (std::ranges::find_first_of(close[i]->set, names) != close[i]->set.end()) with += masses[i];
    if (with >= mass) continue;
    log.push_back(fmt::format("evidence limits {} from {:.3f} to {:.3f}",
                              problem.candidates[candidate].label(), mass, with));
    mass = with;
  }
}

void tell_evidence(Problem& problem, const Search& search, std::vector<std::string>& log) {
  const auto sets = nearest(search, kAnySize);
  problem.repeatable_error = {};
  const auto bagged = bagged_masses(problem, sets);
  for (std::size_t i = 0; i < sets.size(); ++i)
    log.push_back(
        fmt::format("resampled trials: mass {:.3f} {}", bagged[i], set_text(problem, sets[i]->set)));
  problem.repeatable_error = repeatable_error(problem, signatures_at(problem, search.null().fit.point));
  std::vector<WeighedAnswer> all;
  for (const SetFit* fit : sets) {
    const auto evidence = evidence_of(problem, *fit);
    const double log_mass = log_mass_of(problem, *fit, evidence);
    all.push_back({set_text(problem, fit->set), log_mass});
    if (fit != &search.best() && !fit->set.empty()) continue;
    const auto laws = unknown_laws(problem, fit->fit.point, evidence.times);
    const double prior = std::log(kLimits.unknown_expected / static_cast<double>(laws.size()));
    for (std::size_t i = 0; i < laws.size() && i < kLawsWeighed; ++i)
      all.push_back({fmt::format("{} and unknown at {} of {}", set_text(problem, fit->set),
                                 laws[i].family.port, laws[i].family.variable),
                     log_mass + laws[i].log_factor + prior});
  }
  std::ranges::sort(all, std::greater<>{}, &WeighedAnswer::log_mass);
  double total = 0.0;
  for (const auto& one : all) total += std::exp(one.log_mass - all.front().log_mass);
  for (const auto& one : all)
    log.push_back(fmt::format("evidence: mass {:.3f}, ln {:.1f} {}",
                              std::exp(one.log_mass - all.front().log_mass) / total,
                              one.log_mass - all.front().log_mass, one.what));
}

}  // namespace sandhopper::diagnose
