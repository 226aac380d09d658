#include "tools/diagnose/evidence/search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "tools/diagnose/discrepancy/left_over.hpp"
#include "tools/diagnose/evidence/limits.hpp"
#include "tools/diagnose/evidence/log_evidence.hpp"
#include "tools/diagnose/evidence/needed.hpp"
#include "tools/diagnose/evidence/search_parts.hpp"
#include "tools/diagnose/fit/linearise.hpp"

namespace sandhopper::diagnose {
namespace {

// Prior probability that a given listed effect is missing. Set by hand, near the inverse of their number.
constexpr double kPriorOfAnEffect = 1.0 / 40.0;
// Prior odds: "something is missing" against "one more effect is missing". Set by hand.
constexpr double kLikelierThanOneMore = 2.0;
// Standard deviation of ln(size / typical) for sizes below the typical one; for larger sizes it is
// Limits::size_spread. It is wider because small effects are common, while many times the typical size often
// means two effects that nearly cancel each other. Set by hand.
constexpr double kSpreadBelow = 1.8;

// Skip a nuisance step that gains less than this fraction of the trial's deviance above the noise.
constexpr double kFarGain = 1e-3;
constexpr int kNullRestarts = 3;            // most rounds of refits of the null
constexpr std::size_t kFitsToFreeNull = 2;  // single effects that are fitted in each round
// Keep the null fit unless the refit gains at least 2 % of what the closest single effect gained.
constexpr double kFreed = 0.02;
// In evaluate_straight(): candidates that are fitted, and trials in which all candidates are compared first.
constexpr std::size_t kStraightFits = 3, kTrialsHeld = 5;

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
    sum += std::pow(size / (size < 0.0 ? kSpreadBelow : kLimits.size_spread), 2);
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
         2.0 * log_prior_of_statements(*problem_, fit.set) -
         (fit.set.empty() ? 0.0 : 2.0 * std::log(kLikelierThanOneMore));
}

const std::vector<Screened>& Search::screened(const std::vector<std::size_t>& set) {
  const auto it = screens_.find(set);
  if (it != screens_.end()) return it->second;
  const Point& at = sets_.at(set).fit.point;
  return screens_[set] = screen(*problem_, at, columns_for(set),
                                signatures_at(*problem_, at, {.laws = false, .columns = columns_for(set)}));
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
  for (const auto& added : screen(*problem_, straight, &columns,
                                  signatures_at(*problem_, straight, {.laws = false, .columns = &columns})))
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
  for (std::size_t i = 0; i < kStraightFits && i < order.size() && !over(); ++i)
    fit_straight(from, order[i]->start, columns, closest);
}

// Fits one set from a start with the nuisances at their prior means. `closest`: smallest deviance so far.
void Search::fit_straight(const SetFit& from, const Point& start, const std::vector<KeptColumns>& columns,
                          double& closest) {
  SetFit result;
  result.set = with(from.set, start.hypothesis.candidates.back());
  result.straight = true;
  FitOptions first = options_.costly ? kCostly : FitOptions();
  first.max_iterations = kRough.max_iterations;
  first.columns = &columns;
  result.fit = fit_at(start, first);
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

// True if the nuisance parameters have absorbed something that is missing.
bool Search::nuisances_have_absorbed(const Fit& fit) const {
  return have_absorbed(fit.deviance, problem_->rows(), largest_common_shift(*problem_, fit.point).z);
}

// True if `with` removes most of a nuisance offset that all trials have in common in `without`.
bool Search::removes_common_shift(const Fit& without, const Fit& with) const {
  return removes_offset(largest_common_shift(*problem_, without.point).z,
                        largest_common_shift(*problem_, with.point).z);
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

// Removes each effect of the best set in turn and tries all others in its place.
void Search::exchange() {
  for (int round = 0; round < 3 && !over(); ++round) {
    const auto before = best_;
    for (const auto candidate : before) {
      if (over()) break;
      const auto rest = without(before, candidate);
      fit_part(SetFit(sets_.at(before)), rest,
               options_.costly ? kRough : FitOptions());  // enough for a screen
      expand(rest, options_.fits_per_screen);
    }
    choose_best();
    if (best_ == before) break;
  }
}

// The null fit may be stuck in a local minimum of the nuisances, and an effect may lead out of it. Refit the
// null from there. Otherwise the effect would get credit for what the nuisances explain.
void Search::restart_null() {
  std::set<std::vector<std::size_t>> started_from;
  for (int round = 0; round < kNullRestarts; ++round) {
    if (over()) return;
    const double before = null().fit.deviance;
    expand({}, kFitsToFreeNull);
    if (round == 0 && options_.straight && nuisances_have_absorbed(null().fit))
      evaluate_straight(SetFit(null()));
    const SetFit* closest = nullptr;
    for (const auto& [set, fit] : sets_)
      if (set.size() == 1 && !started_from.contains(set) &&
          (closest == nullptr || fit.fit.deviance < closest->fit.deviance))
        closest = &fit;
    if (closest == nullptr || closest->fit.deviance > before - kWorthAFit) return;
    started_from.insert(closest->set);
    Point start = closest->fit.point;
    start.hypothesis = {};
    Fit again = fit_at(start);
    if (again.deviance > before - kFreed * std::max(1.0, before - closest->fit.deviance)) return;
    SetFit freed = null();
    freed.fit = std::move(again);
    std::erase_if(sets_, [](const auto& entry) { return !entry.second.straight; });
    screens_.clear();
    if (!sets_.empty()) straight_[{}] = freed.fit.deviance;
    sets_[{}] = std::move(freed);
  }
}

const SetFit& Search::run(const Point& start, const std::vector<Point>& seeds) {
  sets_.clear();
  screens_.clear();
  straight_.clear();
  SetFit null;
  null.fit = fit_at(start, {.columns_made_here = true});
  null.needed = null.judged = true;
  sets_[{}] = std::move(null);
  if (options_.free_null) restart_null();
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
  grow_and_improve();
  return best();
}

// After a limit of time the best of the fitted sets counts.
void Search::grow_and_improve() {
  grow_sets();
  if (!over()) improve();
  if (stopped_) choose_best();
}

void Search::widen(std::size_t most_effects) {
  options_.most_effects = most_effects;
  if (over()) return;
  grow_and_improve();
}

// Sets of one effect, then each of the nearest ones with one more, and so on.
void Search::grow_sets() {
  std::vector<std::vector<std::size_t>> front{{}};
  const double sizes = static_cast<double>(options_.most_effects + 1);
  for (std::size_t size = 1; size <= options_.most_effects && !over(); ++size) {
    // Only for the set with the smallest deviance: this costs as much as a screen with all its fits.
    const SetFit nearest = sets_.at(front.front());
    if (options_.straight && nuisances_have_absorbed(nearest.fit)) evaluate_straight(nearest);
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
    const SetFit& smaller = sets_.at(front.front());
    // While physics is missing, the trials also scatter for that reason. That scatter must not end the
    // growth.
    const double noise = std::min(dispersion_, std::max(1.0, smaller.fit.deviance / problem_->rows()));
    const bool worse = criterion(*grown.front(), noise) >= criterion(smaller, noise);
    front.clear();
    const double explained = this->null().fit.deviance - grown.front()->fit.deviance;
    for (const auto* fit : grown)
      if (front.size() < options_.beam && worth_growing(*problem_, fit->fit.point.hypothesis) &&
          fit->fit.deviance - grown.front()->fit.deviance <= kNearlyAsGood * explained)
        front.push_back(fit->set);
    if (front.empty() || (worse && best_ == before)) break;
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
  complete();
}

void Search::complete() {
  finish_rivals();
  grow_best();
  settle_best();
}

}  // namespace sandhopper::diagnose
