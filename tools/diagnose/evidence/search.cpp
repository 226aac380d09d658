#include "tools/diagnose/evidence/search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "tools/diagnose/discrepancy/left_over.hpp"
#include "tools/diagnose/evidence/proposals.hpp"
#include "tools/diagnose/evidence/search_parts.hpp"
#include "tools/diagnose/fit/linearise.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr double kWorthAFit = 6.0;  // Smallest drop of the deviance that justifies a fit.
// Prior probability that a given listed effect is missing.
constexpr double kPriorOfAnEffect = 1.0 / 40.0;
// Prior odds: "something is missing" against "one more effect is missing".
constexpr double kLikelierThanOneMore = 2.0;
constexpr double kLinearError =
    0.05;  // Error of a proposal's linear deviance, relative to the explained deviance.
// Prior of ln(size / typical): standard deviation below and above 1. Small effects are common. Large sizes
// are suspect: two effects that nearly cancel each other are both many times their typical size.
constexpr double kSpreadBelow = 1.8;
constexpr double kSpreadAbove = 1.0;
// Refit a set if its deviance / dispersion exceeds the proposal's by more than this.
constexpr double kCaught = 3.0;
// Sets within this fraction of the explained deviance are extended or used as start points.
constexpr double kNearlyAsGood = 0.35;

constexpr FitOptions kRough{
    .max_iterations = 6, .tolerance = 2.0, .refresh = false};  // Settings for the first fit of a set.
// Skip a nuisance step that gains less than this fraction of the trial's deviance above the noise.
constexpr double kFarGain = 1e-3;
constexpr double kRival = 20.0;  // Largest distance in the criterion at which a rival's fit is completed.
// Possible further drop of a rough fit, relative to the explained deviance: of every set, and of the
// `kNearestRivals` nearest sets.
constexpr double kUnsettled = 1e-5, kFarUnsettled = 0.02;
constexpr std::size_t kNearestRivals = 3;
// p-value below which an effect is added to the best set by its own dispersion.
constexpr double kSurely = 1e-8;
// The real drop of the deviance may be this many times its linear estimate.
constexpr double kPromiseShort = 1.5;
constexpr int kNullRestarts = 3;
constexpr std::size_t kFitsToFreeNull = 2;
// Keep the null fit unless the refit gains at least 2 % of what the closest single effect gained.
constexpr double kFreed = 0.02;
// The nuisances have absorbed something if the deviance per row exceeds this value.
constexpr double kBentPerRow = 1.5;
// The same if a nuisance's mean over the trials has a larger |z| than this. With nothing missing |z| is at
// most 2.9.
constexpr double kBentLean = 4.0;
// An effect explains the common nuisance offset if |z| falls below this fraction.
constexpr double kUnbent = 0.6;
constexpr std::size_t kStraightFits = 3, kTrialsHeld = 5;
// Fraction of the gain of a law of free form that a set must explain to replace the law.
constexpr double kNearlyAll = 0.9;
constexpr std::array kCommonSizes{0.5, 2.0, -0.5, -2.0};  // Start values in typical sizes.

std::vector<std::size_t> with(std::vector<std::size_t> set, std::size_t candidate) {
  set.push_back(candidate);
  std::sort(set.begin(), set.end());
  return set;
}

// -2 ln(prior density of the sizes), up to a constant.
double size_deviance(const Problem& problem, const Hypothesis& hypothesis) {
  double sum = 0.0;
  for (std::size_t e = 0; e < hypothesis.candidates.size(); ++e) {
    const double size = std::log(std::max(typicals_of(problem, hypothesis, e), 1e-3));
    sum += std::pow(size / (size < 0.0 ? kSpreadBelow : kSpreadAbove), 2);
  }
  return sum;
}

// True if every effect is large enough that a further effect beside it is worth a fit.
bool worth_growing(const Problem& problem, const Hypothesis& hypothesis) {
  for (std::size_t e = 0; e < hypothesis.candidates.size(); ++e)
    if (typicals_of(problem, hypothesis, e) < 0.5 * kSmallestOfTypical) return false;
  return true;
}

}  // namespace

double Search::cost_of_an_effect() const { return -2.0 * std::log(kPriorOfAnEffect) + cost_of_a_parameter(); }

double Search::cost_of_a_parameter() const {
  return std::log(std::max<double>(3.0, static_cast<double>(problem_->trials.size())));
}

double Search::criterion(const SetFit& fit) const { return criterion(fit, dispersion_); }

double Search::criterion(const SetFit& fit, double dispersion) const {
  const auto effects = static_cast<double>(fit.set.size());
  const auto parameters = static_cast<double>(fit.fit.point.hypothesis.parameters());
  return fit.fit.deviance / dispersion + size_deviance(*problem_, fit.fit.point.hypothesis) +
         effects * cost_of_an_effect() + (parameters - effects) * cost_of_a_parameter() -
         (fit.set.empty() ? 0.0 : 2.0 * std::log(kLikelierThanOneMore));
}

const std::vector<Screened>& Search::screened(const std::vector<std::size_t>& set) {
  const auto it = screens_.find(set);
  if (it != screens_.end()) return it->second;
  const Point& at = sets_.at(set).fit.point;
  return screens_[set] =
             screen(*problem_, at, columns_for(set), signatures_at(*problem_, at, {.laws = false}));
}

void Search::evaluate(const SetFit& from, const Screened& added) {
  const auto set = with(from.set, added.candidate);
  if (sets_.contains(set)) return;
  Point start = from.fit.point;
  start.hypothesis.candidates.push_back(added.candidate);
  start.hypothesis.values.push_back(added.values);
  SetFit result;
  result.set = set;
  result.rough = true;
  FitOptions rough = kRough;
  rough.columns = columns_for(from.set);
  rough.of_use_below = from.fit.deviance;
  result.fit = fit_at(start, rough);
  // The first fit gained much less than the linear estimate: fit again from other sizes, if the estimated
  // gain exceeds the penalty of an effect.
  if (options_.second_starts && from.fit.deviance - result.fit.deviance < 0.5 * added.gain &&
      added.gain > cost_of_an_effect() * dispersion_) {
    const auto& parameters = problem_->candidates[added.candidate].parameters;
    for (const double factor : {0.3, 1.0, -1.0}) {
      if (factor < 0.0 && !parameters[0].either_sign) continue;
      auto values = added.values;
      values[0] = std::clamp(factor * parameters[0].typical, parameters[0].low, parameters[0].high);
      start.hypothesis.values.back() = values;
      Fit again = fit_at(start, rough);
      if (again.deviance < result.fit.deviance) result.fit = std::move(again);
    }
  }
  // The fit with the effect must not be worse than the fit without it: start with the effect nearly off.
  if (result.fit.deviance > from.fit.deviance + 0.1) {
    auto values = added.values;
    values[0] = std::clamp(
        0.01 * std::copysign(problem_->candidates[added.candidate].parameters[0].typical, added.values[0]),
        problem_->candidates[added.candidate].parameters[0].low,
        problem_->candidates[added.candidate].parameters[0].high);
    start.hypothesis.values.back() = values;
    Fit again = fit_at(start, rough);
    if (again.deviance < result.fit.deviance) result.fit = std::move(again);
  }
  sets_[set] = std::move(result);
}

// If the model lacks something large, the nuisance parameters absorb it, and derivatives at that fit point at
// the nuisances. So also compare every candidate at common sizes with the nuisances at their prior means: the
// residual there still shows the missing effect. The nearest candidates are fitted.
void Search::evaluate_straight(const SetFit& from) {
  const auto before = straight_.find(from.set);
  if (before != straight_.end() && before->second == from.fit.deviance) return;
  straight_[from.set] = from.fit.deviance;
  Point straight = null_point(*problem_);
  straight.hypothesis = from.fit.point.hypothesis;
  const auto columns = columns_at(*problem_, straight);
  struct Nearest {
    Point start;
    double deviance = 0.0;  // after one linear step of the nuisance parameters
  };
  std::map<std::size_t, Nearest> nearest;  // by candidate
  const std::size_t every = std::max<std::size_t>(1, problem_->trials.size() / kTrialsHeld);
  const auto hold = [&](std::size_t candidate, const std::vector<double>& values) {
    Nearest one{straight, 0.0};
    one.start.hypothesis.candidates.push_back(candidate);
    one.start.hypothesis.values.push_back(values);
    for (const auto& trial : linearise_all(*problem_, one.start, {}, {.columns = &columns, .every = every}))
      one.deviance += trial.gram(0, 0);
    const auto known = nearest.find(candidate);
    if (known == nearest.end() || one.deviance < known->second.deviance)
      nearest.insert_or_assign(candidate, std::move(one));
  };
  for (const auto& added :
       screen(*problem_, straight, &columns, signatures_at(*problem_, straight, {.laws = false})))
    hold(added.candidate, added.values);
  for (std::size_t c = 0; c < problem_->candidates.size(); ++c) {
    if (over()) return;
    if (straight.hypothesis.contains(c)) continue;
    const auto& p = problem_->candidates[c].parameters[0];
    for (auto values : shape_choices(problem_->candidates[c])) {
      if (values[0] != 0.0) {
        hold(c, values);
        continue;
      }
      for (const double typicals : kCommonSizes) {
        values[0] = typicals * p.typical;
        if ((typicals > 0.0 || p.either_sign) && values[0] >= p.low && values[0] <= p.high) hold(c, values);
      }
    }
  }
  std::vector<const Nearest*> order;
  for (const auto& [candidate, one] : nearest) order.push_back(&one);
  std::ranges::sort(order, {}, &Nearest::deviance);
  double closest = from.fit.deviance;
  for (std::size_t i = 0; i < kStraightFits && i < order.size() && !over(); ++i) {
    SetFit result;
    result.set = with(from.set, order[i]->start.hypothesis.candidates.back());
    result.fit = fit_at(order[i]->start, {.max_iterations = kRough.max_iterations, .columns = &columns});
    result.rough = true;
    // The nuisances start far from their optimum: finish the fit of every set that comes near.
    if (result.fit.status == FitStatus::failed &&
        result.fit.deviance < closest + kNearlyAsGood * (from.fit.deviance - closest)) {
      result.fit = fit_at(Point(result.fit.point), {.columns = &columns});
      result.rough = false;
    }
    closest = std::min(closest, result.fit.deviance);
    const auto known = sets_.find(result.set);
    if (known == sets_.end() || result.fit.deviance < known->second.fit.deviance)
      sets_[result.set] = std::move(result);
  }
}

// True if the nuisance parameters have absorbed something that is missing.
bool Search::is_bent(const Fit& fit) const {
  return fit.deviance > kBentPerRow * problem_->rows() ||
         std::abs(largest_lean(*problem_, fit.point).z) > kBentLean;
}

// True if `with` removes most of a nuisance offset that all trials have in common in `without`.
bool Search::unbends(const Fit& without, const Fit& with) const {
  const double before = std::abs(largest_lean(*problem_, without.point).z);
  return before > kBentLean && std::abs(largest_lean(*problem_, with.point).z) < kUnbent * before;
}

void Search::expand(const std::vector<std::size_t>& from, std::size_t fits) {
  if (over()) return;
  const SetFit parent = sets_.at(from);
  options_.progress(share_, "screening effects");
  const auto candidates = screened(from);
  std::size_t done = 0;
  for (const auto& s : candidates) {
    if (done >= fits || s.gain < kWorthAFit ||
        (done >= 3 && s.gain < options_.hopeless * candidates.front().gain) || over())
      break;
    const double part = static_cast<double>(done) / static_cast<double>(std::min(fits, candidates.size()));
    options_.progress(share_ + share_of_screen_ * part, "fitting effects");
    evaluate(parent, s);
    ++done;
  }
}

// Derivatives by the nuisances at the best set so far; for the empty set those at the null.
const std::vector<KeptColumns>* Search::columns_for(const std::vector<std::size_t>& set) const {
  return set.empty() || columns_.empty() ? &problem_->kept_columns : &columns_;
}

Fit Search::fit_at(const Point& start, FitOptions options) const {
  if (options.columns == nullptr) options.columns = columns_for(start.hypothesis.candidates);
  options.far_gain = kFarGain;
  options.tolerance *= dispersion_;  // Gains count relative to the scatter between trials.
  return fit_from(*problem_, start, options);
}

void Search::finish(SetFit& fit) const {
  if (!fit.rough) return;
  fit.fit = fit_at(Point(fit.fit.point));
  fit.rough = fit.judged = false;
  borrow(fit);
}

// A trial's deviance can have two minima. If another set found a much lower one for a trial, restart this set
// from the nuisance parameters found there.
void Search::borrow(SetFit& fit) const {
  Point start = fit.fit.point;
  bool lower = false;
  for (std::size_t t = 0; t < start.nuisances.size(); ++t) {
    double least = fit.fit.trial_deviance[t] - kWorthAFit * dispersion_;
    for (const auto& [set, other] : sets_)
      if (other.fit.trial_deviance[t] < least) {
        least = other.fit.trial_deviance[t];
        start.nuisances[t] = other.fit.point.nuisances[t];
        lower = true;
      }
  }
  if (!lower) return;
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
               far = best_so_far + std::max(kRival, kFarUnsettled * explained);
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
    return added->p_value < kSurely &&
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

namespace {

std::vector<std::size_t> named_part(const SetFit& fit) {
  std::vector<std::size_t> part;
  for (const auto& evidence : fit.evidence)
    if (!evidence.too_small && !evidence.unnoticed) part.push_back(evidence.candidate);
  std::ranges::sort(part);
  return part;
}

}  // namespace

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
    // Complete a rough fit only if its effects may be needed.
    if (fit.rough && !fit.hopeless) {
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
bool Search::fit_part(const SetFit& whole, const std::vector<std::size_t>& part) {
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
  fit.fit = fit_at(start);
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

// Removes each effect of the best set in turn and tries all others in its place.
void Search::exchange() {
  for (int round = 0; round < 3 && !over(); ++round) {
    const auto before = best_;
    for (const auto candidate : before) {
      if (over()) break;
      const auto rest = without(before, candidate);
      fit_part(SetFit(sets_.at(before)), rest);
      expand(rest, options_.fits_per_screen);
    }
    choose_best();
    if (best_ == before) break;
  }
}

// The null fit may be stuck in a local minimum of the nuisances, and an effect may lead out of it. Refit the
// null from there. Otherwise the effect would get credit for what the nuisances explain.
void Search::restart_null() {
  for (int round = 0; round < kNullRestarts; ++round) {
    if (over()) return;
    const double before = null().fit.deviance;
    expand({}, kFitsToFreeNull);
    if (round == 0 && options_.straight && is_bent(null().fit)) evaluate_straight(SetFit(null()));
    const SetFit* closest = nullptr;
    for (const auto& [set, fit] : sets_)
      if (set.size() == 1 && (closest == nullptr || fit.fit.deviance < closest->fit.deviance)) closest = &fit;
    if (closest == nullptr || closest->fit.deviance > before - kWorthAFit) return;
    Point start = closest->fit.point;
    start.hypothesis = {};
    Fit again = fit_at(start);
    if (again.deviance > before - kFreed * std::max(1.0, before - closest->fit.deviance)) return;
    SetFit freed = null();
    freed.fit = std::move(again);
    sets_.clear();
    screens_.clear();
    straight_.clear();
    sets_[{}] = std::move(freed);
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

const SetFit& Search::run(const Point& start, const std::vector<Point>& seeds) {
  sets_.clear();
  screens_.clear();
  straight_.clear();
  SetFit null;
  null.fit = fit_at(start, {.columns_made_here = true});
  null.needed = null.judged = true;
  sets_[{}] = std::move(null);
  restart_null();
  if (!seeds.empty()) columns_ = columns_at(*problem_, seeds.front());
  for (const auto& seed : seeds) {
    if (over()) break;
    SetFit fit;
    fit.set = seed.hypothesis.candidates;
    std::sort(fit.set.begin(), fit.set.end());
    fit.rough = true;
    fit.fit = fit_at(seed, kRough);
    sets_[fit.set] = std::move(fit);
  }
  grow_sets();
  if (!over()) improve();
  return best();
}

// Sets of one effect, then each of the nearest ones with one more, and so on.
void Search::grow_sets() {
  std::vector<std::vector<std::size_t>> front{{}};
  const double sizes = static_cast<double>(options_.most_effects + 1);
  for (std::size_t size = 1; size <= options_.most_effects && !over(); ++size) {
    // Only for the nearest set: this costs as much as a screen with all its fits.
    const SetFit nearest = sets_.at(front.front());
    if (options_.straight && is_bent(nearest.fit)) evaluate_straight(nearest);
    share_of_screen_ = 1.0 / (sizes * static_cast<double>(front.size()));
    for (std::size_t i = 0; i < front.size(); ++i) {
      share_ = static_cast<double>(size - 1) / sizes + share_of_screen_ * static_cast<double>(i);
      expand(front[i], size == 1 ? options_.fits_of_singles : options_.fits_per_screen);
    }
    std::vector<const SetFit*> grown;
    for (const auto& [set, fit] : sets_)
      if (set.size() == size) grown.push_back(&fit);
    if (grown.empty()) break;
    std::sort(grown.begin(), grown.end(),
              [](const SetFit* a, const SetFit* b) { return a->fit.deviance < b->fit.deviance; });
    const auto before = best_;
    choose_best();
    const double smaller = criterion(sets_.at(front.front()));
    front.clear();
    const double explained = this->null().fit.deviance - grown.front()->fit.deviance;
    for (const auto* fit : grown)
      if (front.size() < options_.beam && worth_growing(*problem_, fit->fit.point.hypothesis) &&
          fit->fit.deviance - grown.front()->fit.deviance <= kNearlyAsGood * explained)
        front.push_back(fit->set);
    if (front.empty() || (criterion(*grown.front()) >= smaller && best_ == before)) break;
  }
}

// Exchanges, deletions and proposals around the best set.
void Search::improve() {
  const double all =
      static_cast<double>(options_.most_effects) / static_cast<double>(options_.most_effects + 1);
  const auto at = [&](double part, const char* what) {
    share_ = all + (1.0 - all) * part;
    share_of_screen_ = 0.0;
    options_.progress(share_, what);
  };
  at(0.0, "exchanging effects");
  borrow(sets_.at({}));
  exchange();
  at(0.4, "leaving effects out");
  const auto before = best_;
  prune();
  if (best_ != before) exchange();
  at(0.6, "trying other sets");
  for (int round = 0; round < 3 && options_.proposals > 0; ++round) {
    const auto so_far = best_;
    if (over() || !try_proposals() || best_ == so_far) break;
    prune();
  }
  at(0.8, "completing the fits of rivals");
  finish_rivals();
  grow_best();
  settle_best();
}

}  // namespace sandhopper::diagnose
