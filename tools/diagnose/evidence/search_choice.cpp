#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "tools/diagnose/evidence/proposals.hpp"
#include "tools/diagnose/evidence/search.hpp"
#include "tools/diagnose/evidence/search_parts.hpp"
#include "tools/diagnose/fit/levels.hpp"
#include "tools/diagnose/fit/linearise.hpp"

// Choice of the best set among the fitted ones, with the fits that a fair comparison needs.
namespace sandhopper::diagnose {
namespace {

// Possible further drop of a rough fit, relative to the explained deviance. The `kNearestRivals` nearest sets
// are completed if they explain all but kLevel of it.
constexpr double kUnsettled = 1e-5;
constexpr std::size_t kNearestRivals = 3;
// The real drop of the deviance may be this many times its linear estimate.
constexpr double kPromiseShort = 1.5;
// Fraction of the gain of a law of free form that a set must explain to replace the law.
constexpr double kNearlyAll = 0.9;
// Error of a proposal's linear deviance, relative to the explained deviance.
constexpr double kLinearError = 0.05;
// Refit a set if its deviance / dispersion exceeds the proposal's by more than this.
constexpr double kCaught = 3.0;

constexpr double kStartBeside = 0.3;  // Least start value beside the best set, in typical sizes.

std::vector<std::size_t> named_part(const SetFit& fit) {
  std::vector<std::size_t> part;
  for (const auto& evidence : fit.evidence)
    if (!evidence.too_small && !evidence.unnoticed) part.push_back(evidence.candidate);
  std::ranges::sort(part);
  return part;
}

}  // namespace

void Search::finish(SetFit& fit) const {
  if (!fit.rough) return;
  fit.fit = fit_at(Point(fit.fit.point), options_.costly ? kCostly : FitOptions());
  fit.rough = fit.judged = false;
  borrow(fit);
}

// A trial's deviance can have two minima. If another set found a much lower one for a trial, restart this set
// from the nuisance parameters found there; for a costly plant only if they lower that trial with these
// effects, too.
void Search::borrow(SetFit& fit) const {
  Point start = fit.fit.point;
  const auto& own = fit.fit.trial_deviance;
  const double much = kWorthAFit * dispersion_;
  for (std::size_t t = 0; t < own.size(); ++t) {
    double least = own[t] - much;
    for (const auto& [set, other] : sets_)
      if (other.fit.trial_deviance[t] < least) {
        least = other.fit.trial_deviance[t];
        start.nuisances[t] = other.fit.point.nuisances[t];
      }
  }
  if (options_.costly && start.nuisances != fit.fit.point.nuisances) {
    const Fit there = fit_at(start, {.max_iterations = 0});
    for (std::size_t t = 0; t < own.size(); ++t)
      start.nuisances[t] = (there.trial_deviance[t] < own[t] - much ? there : fit.fit).point.nuisances[t];
  }
  if (start.nuisances == fit.fit.point.nuisances) return;
  Fit again = fit_at(start);
  if (again.deviance >= fit.fit.deviance) return;
  fit.fit = std::move(again);
  fit.judged = false;
}

// A rival must not lose only because its rough fit stopped early. Complete the fits of near rivals. If one
// gets ahead, choose again.
void Search::finish_rivals() {
  const double explained = (null().fit.deviance - best().fit.deviance) / dispersion_;
  const double best_so_far = criterion(best()),
               limit = best_so_far + std::max(kRival, kUnsettled * explained),
               far = best_so_far + std::max(kRival, kLevel * explained);
  std::vector<SetFit*> order;
  for (auto& [set, fit] : sets_)
    if (set.size() <= best_.size()) order.push_back(&fit);
  std::ranges::sort(order, {}, [&](const SetFit* fit) { return criterion(*fit); });
  bool ahead = false;
  for (std::size_t i = 0; i < order.size() && !over(); ++i) {
    SetFit& fit = *order[i];
    const bool near = i <= kNearestRivals && criterion(fit) < far;
    if (!fit.rough || (!near && criterion(fit) - kPromiseShort * fit.fit.promised / dispersion_ >= limit))
      continue;
    finish(fit);
    ahead = ahead || criterion(fit) < best_so_far;
  }
  if (!ahead) return;
  choose_best();
  prune();
}

// The trials may scatter much more in one effect than in another, and the common dispersion would hide the
// second effect. Add an effect that is certain and lowers the criterion by its own dispersion.
void Search::grow_best() {
  const auto pays = [&](SetFit& fit) {
    if (!fit.judged) judge(fit);
    if (!fit.needed) return false;
    const auto added = std::ranges::find_if(
        fit.evidence, [&](const auto& e) { return !std::ranges::binary_search(best_, e.candidate); });
    return added->p_value < kBeyondDoubt &&
           criterion(fit, added->dispersion) + kWorthAFit < criterion(best(), added->dispersion);
  };
  for (bool grown = true; grown && best_.size() < options_.most_effects && !over();) {
    std::vector<SetFit*> order;
    for (auto& [set, fit] : sets_)
      if (!best_.empty() && set.size() == best_.size() + 1 && std::ranges::includes(set, best_) &&
          !fit.rough && fit.fit.status != FitStatus::failed)
        order.push_back(&fit);
    std::ranges::sort(order, {}, [](const SetFit* fit) { return fit->fit.deviance; });
    const auto found = std::ranges::find_if(order, [&](SetFit* fit) { return pays(*fit); });
    grown = found != order.end();
    if (grown) best_ = (*found)->set;
  }
}

// Refit with derivatives at the best set itself: only these show the remaining nuisance offsets.
void Search::settle_best() {
  SetFit& fit = sets_.at(best_);
  if (fit.set.empty()) return;
  columns_ = columns_at(*problem_, fit.fit.point);
  Fit again = fit_at(Point(fit.fit.point));
  if (again.deviance < fit.fit.deviance) fit.fit = std::move(again);
  borrow(fit);
}

std::vector<double> Search::deviances_without_one(const SetFit& fit) const {
  std::vector<double> deviances;
  for (const auto candidate : fit.set) {
    const auto parent = sets_.find(without(fit.set, candidate));
    deviances.push_back(parent == sets_.end() ? -1e300 : parent->second.fit.deviance);
  }
  return deviances;
}

// True if the set was not judged yet, or if a set without one of its effects has since found a lower
// deviance.
bool Search::is_to_be_judged(const SetFit& fit) const {
  if (!fit.judged) return true;
  const auto now = deviances_without_one(fit);
  for (std::size_t i = 0; i < fit.beside.size(); ++i)
    if (now[i] > -1e299 && now[i] < fit.beside[i] - kWorthAFit) return true;
  return false;
}

void Search::choose_best() {
  // Smallest deviance first, to get the dispersion from the best-fitting set that needs all its effects.
  std::vector<SetFit*> order;
  for (auto& [set, fit] : sets_)
    if (fit.fit.status != FitStatus::failed || fit.rough || set.empty()) order.push_back(&fit);
  std::sort(order.begin(), order.end(),
            [](const SetFit* a, const SetFit* b) { return a->fit.deviance < b->fit.deviance; });
  const auto needed = [&](SetFit& fit) {
    if (is_to_be_judged(fit)) judge(fit);
    // Complete a rough fit only if its effects may be needed and there is time.
    if (fit.rough && !fit.hopeless && !stopped_) {
      finish(fit);
      judge(fit);
    }
    return fit.needed && (fit.fit.status != FitStatus::failed || fit.set.empty());
  };
  for (auto* fit : order)
    if (needed(*fit)) {
      dispersion_ = fit->dispersion;
      break;
    }
  std::sort(order.begin(), order.end(),
            [&](const SetFit* a, const SetFit* b) { return criterion(*a) < criterion(*b); });
  const auto before = best_;
  // Sets with a smaller criterion that hold an effect too small to be named.
  std::vector<const SetFit*> trivial;
  for (auto* fit : order) {
    if (needed(*fit)) {
      best_ = fit->set;
      break;
    }
    const bool differs = std::ranges::any_of(fit->evidence, &EffectEvidence::unnoticed);
    if (fit->judged && fit->sound && !differs) trivial.push_back(fit);
  }
  // A better set may consist of `part` and an effect too small to be named. Then the other effect in the best
  // set only replaces the small one: name `part` alone.
  for (const auto* fit : trivial) {
    const auto part = named_part(*fit);
    if (part.size() < best_.size() && std::ranges::includes(best_, part) && sets_.contains(part) &&
        criterion(*fit) + kWorthAFit < criterion(best()) && needed(sets_.at(part)))
      best_ = part;
  }
  if (best_ != before) columns_ = columns_at(*problem_, best().fit.point);
}

// Fits `part` of the effects of `whole`. A part that was fitted before is only refitted if its deviance is
// higher than the gains of the other effects can explain: then the earlier fit stopped in a worse minimum.
// True if a fit was stored.
bool Search::fit_part(const SetFit& whole, const std::vector<std::size_t>& part, const FitOptions& options) {
  const auto known = sets_.find(part);
  if (known != sets_.end()) {
    double others = kWorthAFit * dispersion_;
    for (const auto& evidence : whole.evidence)
      if (!std::ranges::binary_search(part, evidence.candidate)) others += kPromiseShort * evidence.gain;
    if (!whole.judged || known->second.fit.deviance <= whole.fit.deviance + others) return false;
  }
  SetFit fit;
  fit.set = part;
  Point start = whole.fit.point;
  Hypothesis h;
  for (std::size_t i = 0; i < start.hypothesis.candidates.size(); ++i)
    if (std::find(part.begin(), part.end(), start.hypothesis.candidates[i]) != part.end()) {
      h.candidates.push_back(start.hypothesis.candidates[i]);
      h.values.push_back(start.hypothesis.values[i]);
    }
  start.hypothesis = h;
  fit.fit = fit_at(start, options);
  fit.rough = !options.refresh;
  if (known != sets_.end() && known->second.fit.deviance <= fit.fit.deviance) return false;
  sets_[part] = std::move(fit);
  return true;
}

// A set may fit better than the best one but hold an effect it does not need. Fit it without that effect:
// forward search may never have reached the smaller set.
void Search::prune() {
  for (int round = 0; round < 3 && !over(); ++round) {
    std::vector<const SetFit*> order;
    for (const auto& [set, fit] : sets_)
      if (fit.judged && !fit.needed && fit.fit.deviance <= best().fit.deviance) order.push_back(&fit);
    std::ranges::sort(order, {}, [](const SetFit* fit) { return fit->fit.deviance; });
    // Key: the needed part. Value: the set with the smallest deviance that contains it.
    std::map<std::vector<std::size_t>, SetFit> wholes;
    for (const auto* fit : order) {
      std::vector<std::size_t> part;
      for (const auto& evidence : fit->evidence)
        if (evidence.p_value < kSignificance && !evidence.too_small && !evidence.unnoticed)
          part.push_back(evidence.candidate);
      std::sort(part.begin(), part.end());
      if (!part.empty() && part.size() < fit->set.size()) wholes.emplace(part, *fit);
    }
    bool tried = false;
    for (const auto& [part, whole] : wholes)
      if (!over()) tried = fit_part(whole, part) || tried;
    if (!tried) return;
    choose_best();
  }
}

// Fits the sets that `propose` scores best at the best point. Returns true if a set was new or improved.
bool Search::try_proposals() {
  const Point from = best().fit.point;
  const double cost = cost_of_an_effect();
  const double explained = null().fit.deviance - best().fit.deviance;
  const double limit = best().fit.deviance + cost * dispersion_ * static_cast<double>(best_.size()) +
                       kWorthAFit + kLinearError * explained;
  bool tried = false;
  for (const auto& proposal :
       propose(*problem_, from, options_.most_effects, options_.proposals, cost * dispersion_)) {
    auto set = proposal.start.candidates;
    std::sort(set.begin(), set.end());
    if (over()) break;
    if (proposal.deviance > limit) continue;
    const auto before = sets_.find(set);
    const double promised = proposal.deviance - cost * dispersion_ * static_cast<double>(set.size());
    // An earlier fit of the set may have stopped above the deviance that the proposal predicts: fit it again.
    if (before != sets_.end() && before->second.fit.deviance < promised + kCaught * dispersion_) continue;
    SetFit fit;
    fit.set = set;
    Point start = from;
    start.hypothesis = proposal.start;
    fit.fit = fit_at(start, {.of_use_below = limit + kRival * dispersion_});
    if (before != sets_.end() && before->second.fit.deviance <= fit.fit.deviance) continue;
    sets_[set] = std::move(fit);
    tried = true;
  }
  if (tried) choose_best();
  return tried;
}

void Search::fit_every_other() {
  const auto before = best_;
  if (best_.size() > 1) {
    const auto& evidence = best().evidence;
    const auto weakest = std::ranges::min_element(evidence, {}, &EffectEvidence::gain);
    if (weakest != evidence.end()) fit_all_beside(without(best_, weakest->candidate));
  }
  if (best_.size() < options_.most_effects) fit_all_beside(best_);
  if (best_ != before) complete();
}

void Search::fit_all_beside(const std::vector<std::size_t>& set) {
  if (over() || !sets_.contains(set)) return;
  options_.progress(share_, "fitting every other effect");
  const SetFit parent = sets_.at(set);
  const bool second_starts = std::exchange(options_.second_starts, false);
  for (auto added : std::vector<Screened>(screened(set))) {
    if (over()) break;
    const auto& p = problem_->candidates[added.candidate].parameters[0];
    const double least = std::copysign(kStartBeside * p.typical, added.values[0]);
    if (std::abs(added.values[0]) < std::abs(least)) added.values[0] = std::clamp(least, p.low, p.high);
    evaluate(parent, added);
  }
  options_.second_starts = second_starts;
  choose_best();
}

bool Search::name_small(double gain) {
  if (gain <= 0.0) return false;
  const double limit = best().fit.deviance - kNearlyAll * gain;
  std::vector<SetFit*> order;
  for (auto& [set, fit] : sets_)
    if (set.size() > best_.size() && std::ranges::includes(set, best_) && fit.fit.deviance < limit)
      order.push_back(&fit);
  std::ranges::sort(order, {}, [&](const SetFit* fit) { return criterion(*fit); });
  for (auto* fit : order) {
    finish(*fit);
    if (!fit->judged) judge(*fit);
    if (!fit->sound || fit->fit.status == FitStatus::failed) continue;
    best_ = fit->set;
    columns_ = columns_at(*problem_, best().fit.point);
    return true;
  }
  return false;
}

bool Search::name(const std::vector<std::size_t>& set) {
  SetFit& fit = sets_.at(set);
  if (!fit.judged) judge(fit);
  if (std::ranges::any_of(fit.evidence, &EffectEvidence::at_bound)) return false;
  best_ = set;
  columns_ = columns_at(*problem_, best().fit.point);
  return true;
}

std::vector<Point> Search::best_points(std::size_t count) const {
  std::vector<const SetFit*> order;
  const double limit = best().fit.deviance + kNearlyAsGood * (null().fit.deviance - best().fit.deviance);
  for (const auto& [set, fit] : sets_)
    if (!set.empty() && fit.fit.status != FitStatus::failed && fit.fit.deviance <= limit)
      order.push_back(&fit);
  std::sort(order.begin(), order.end(),
            [&](const SetFit* a, const SetFit* b) { return criterion(*a) < criterion(*b); });
  // Skip sets that only add effects to a better set.
  std::vector<const SetFit*> chosen;
  std::vector<Point> points;
  for (const auto* fit : order) {
    if (points.size() == count) break;
    if (std::ranges::any_of(chosen,
                            [&](const SetFit* less) { return std::ranges::includes(fit->set, less->set); }))
      continue;
    chosen.push_back(fit);
    points.push_back(fit->fit.point);
  }
  return points;
}

}  // namespace sandhopper::diagnose
