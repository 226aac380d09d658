#include "tools/diagnose/search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "tools/diagnose/evidence/limits.hpp"
#include "tools/diagnose/left_over.hpp"
#include "tools/diagnose/linearise.hpp"
#include "tools/diagnose/proposals.hpp"
#include "tools/diagnose/search_parts.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr double kWorthAStep = 0.5;
constexpr double kWorthAFit = 6.0;  // drop of the deviance
constexpr double kLinearError =
    0.05;  // of what is explained: a proposal's estimate may be worse than its fit
constexpr double kCaught = 3.0;         // of the deviance over the dispersion, above what a proposal promises
constexpr double kNearlyAsGood = 0.35;  // of the explained deviance: what more may start from

constexpr FitOptions kRough{
    .max_iterations = 6, .tolerance = 2.0, .refresh = false};  // of sets that are only tried
constexpr double kFarGain = 1e-3;                              // of what a trial is off beyond its rows
constexpr double kRival = 20.0;                                // of the criterion
// Of what is explained: a rough fit may be short by so much, a single one of few by far more.
constexpr std::size_t kJudged = 6;          // of the sets that come nearest
constexpr double kPromiseShort = 1.5;  // a linear estimate of a drop may be short by so much
constexpr int kNullRestarts = 3;
constexpr std::size_t kFitsToFreeNull = 2;
constexpr double kFreed = 0.02;      // of a drop that the null fit finds, too
constexpr double kBentPerRow = 1.5;  // deviance from which nuisances are not what they are believed to be
constexpr double kBentLean = 4.0;    // or all trials move one of them alike; with nothing missing up to 2.9
constexpr double kUnbent = 0.6;      // of a lean that is left
constexpr std::size_t kStraightFits = 3, kTrialsHeld = 5;
constexpr std::array kCommonSizes{0.5, 2.0, -0.5, -2.0};  // in typical ones

std::vector<std::size_t> with(std::vector<std::size_t> set, std::size_t candidate) {
  set.push_back(candidate);
  std::sort(set.begin(), set.end());
  return set;
}

// Minus twice the logarithm of how likely these sizes were beforehand.
double size_deviance(const Problem& problem, const Hypothesis& hypothesis) {
  double sum = 0.0;
  for (std::size_t e = 0; e < hypothesis.candidates.size(); ++e) {
    const double size = std::log(std::max(typicals_of(problem, hypothesis, e), 1e-3));
    sum += std::pow(size / kLimits.size_spread, 2);
  }
  return sum;
}

}  // namespace

double Search::cost_of_an_effect() const {
  return -2.0 * log_prior(*problem_, 1) + cost_of_a_parameter();
}

double Search::cost_of_a_parameter() const {
  return std::log(std::max<double>(3.0, static_cast<double>(problem_->trials.size())));
}

double Search::criterion(const SetFit& fit) const {
  const auto effects = static_cast<double>(fit.set.size());
  const auto parameters = static_cast<double>(fit.fit.point.hypothesis.parameters());
  return fit.fit.deviance + size_deviance(*problem_, fit.fit.point.hypothesis) +
         effects * cost_of_an_effect() + (parameters - effects) * cost_of_a_parameter();
}

const std::vector<Screened>& Search::screened(const std::vector<std::size_t>& set) {
  const auto it = screens_.find(set);
  if (it != screens_.end()) return it->second;
  const Point& at = sets_.at(set).fit.point;
  if (set.empty() && options_.of_null != nullptr)
    return screens_[set] = screen(*problem_, at, columns_for(set), *options_.of_null);
  return screens_[set] = screen(*problem_, at, columns_for(set), signatures_at(*problem_, at, {.laws = false}));
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
  // A second start where the first got nowhere near what its linear approximation promised, if that would
  // pay.
  if (options_.second_starts && from.fit.deviance - result.fit.deviance < 0.5 * added.gain &&
      added.gain > cost_of_an_effect()) {
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
  // With the effect nearly off the fit cannot be worse than without it.
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

// Where much is missing, nuisances bend to it, and a derivative there says what bends them back, not what is
// missing. With all nuisances as they are believed the simulation is further off, but off by what is missing:
// there every candidate is held against the recordings at sizes that are common, and those that come nearest
// are fitted.
void Search::evaluate_straight(const SetFit& from) {
  const auto before = straight_.find(from.set);
  if (before != straight_.end() && before->second == from.fit.deviance) return;
  straight_[from.set] = from.fit.deviance;
  Point straight = null_point(*problem_);
  straight.hypothesis = from.fit.point.hypothesis;
  const auto columns = columns_at(*problem_, straight);
  struct Nearest {
    Point start;
    double deviance = 0.0;  // with the nuisances as a linear approximation has them
  };
  std::map<std::size_t, Nearest> nearest;  // of each candidate
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
                                  signatures_at(*problem_, straight, {.laws = false}))) hold(added.candidate, added.values);
  for (std::size_t c = 0; c < problem_->candidates.size(); ++c) {
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
  for (std::size_t i = 0; i < kStraightFits && i < order.size(); ++i) {
    SetFit result;
    result.set = with(from.set, order[i]->start.hypothesis.candidates.back());
    result.fit = fit_at(order[i]->start, {.max_iterations = kRough.max_iterations, .columns = &columns});
    result.rough = true;
    // Nuisances have far to go: no rough fit of what comes near.
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

// Whether nuisances have taken up what is missing.
bool Search::is_bent(const Fit& fit) const {
  return fit.deviance > kBentPerRow * problem_->rows() ||
         std::abs(largest_lean(*problem_, fit.point).z) > kBentLean;
}

// Whether nuisances that all trials bent alike need not be with an effect.
bool Search::unbends(const Fit& without, const Fit& with) const {
  const double before = std::abs(largest_lean(*problem_, without.point).z);
  return before > kBentLean && std::abs(largest_lean(*problem_, with.point).z) < kUnbent * before;
}

void Search::expand(const std::vector<std::size_t>& from, std::size_t fits) {
  const SetFit parent = sets_.at(from);
  const auto& candidates = screened(from);
  std::size_t done = 0;
  for (const auto& s : candidates) {
    if (done >= fits || s.gain < kWorthAFit ||
        (done >= 3 && s.gain < options_.hopeless * candidates.front().gain))
      break;
    evaluate(parent, s);
    ++done;
  }
}

// Derivatives by the nuisances as they are at the best set so far; without effects those of the null.
const std::vector<KeptColumns>* Search::columns_for(const std::vector<std::size_t>& set) const {
  return set.empty() || columns_.empty() ? &problem_->kept_columns : &columns_;
}

Fit Search::fit_at(const Point& start, FitOptions options) const {
  if (options.columns == nullptr) options.columns = columns_for(start.hypothesis.candidates);
  options.far_gain = kFarGain;
  return fit_from(*problem_, start, options);
}

void Search::finish(SetFit& fit) {
  if (!fit.rough) return;
  fit.fit = fit_at(Point(fit.fit.point));
  fit.rough = fit.judged = false;
  borrow(fit);
}

// A trial may have two valleys: where another set's fit brought one much lower, this set starts there, too.
bool Search::borrow(SetFit& fit) const {
  Point start = fit.fit.point;
  bool lower = false;
  for (std::size_t t = 0; t < start.nuisances.size(); ++t) {
    double least = fit.fit.trial_deviance[t] - kWorthAFit;
    for (const auto& [set, other] : sets_)
      if (other.fit.trial_deviance[t] < least) {
        least = other.fit.trial_deviance[t];
        start.nuisances[t] = other.fit.point.nuisances[t];
        lower = true;
      }
  }
  if (!lower) return false;
  Fit again = fit_at(start);
  if (again.deviance >= fit.fit.deviance) return false;
  fit.fit = std::move(again);
  fit.judged = false;
  return true;
}

// What competes with the best must not lose only because it was fitted roughly and stopped short of what it
// might explain.
void Search::finish_rivals() {
  for (int round = 0; round < 3; ++round) {
    const auto before = best_;
    const double least = best().mass_of_both() + std::log(kLimits.member);
    std::vector<SetFit*> order;
    for (auto& [set, fit] : sets_)
      if (fit.rough && fit.judged && fit.mass_of_both() + 0.5 * kPromiseShort * fit.fit.promised > least)
        order.push_back(&fit);
    for (SetFit* fit : order) finish(*fit);
    choose_best();
    if (best_ == before) return;
  }
}

// With derivatives of its own: what nuisances still lean by shows only then.
void Search::settle_best() {
  SetFit& fit = sets_.at(best_);
  if (fit.set.empty()) return;
  columns_ = columns_at(*problem_, fit.fit.point);
  Fit again = fit_at(Point(fit.fit.point));
  if (again.deviance < fit.fit.deviance) fit.fit = std::move(again);
  borrow(fit);
  judge(fit);
}

void Search::judge(SetFit& fit) {
  const AtFit at = linearised_at(*problem_, fit.fit.point, columns_for(fit.set));
  fit.evidence = log_evidence(*problem_, fit.fit, at);
  fit.log_mass = fit.evidence.value + log_prior(*problem_, fit.set.size());
  fit.unknown_log_mass = fit.evidence.with_unknown + log_prior(*problem_, fit.set.size());
  fit.judged = true;
}

// Every effect brings the trials nearer than the set without it does.
bool Search::trials_agree(const SetFit& fit) const {
  if (fit.fit.status == FitStatus::at_bound) return false;
  return std::ranges::all_of(fit.set, [&](std::size_t candidate) {
    const auto part = sets_.find(without(fit.set, candidate));
    return part == sets_.end() ||
           p_of_drops(part->second.fit.trial_deviance, fit.fit.trial_deviance) <= kLimits.trials_agree;
  });
}

bool Search::may_be_answer(SetFit& fit) {
  if (!fit.judged) judge(fit);
  return trials_agree(fit) && (fit.fit.status != FitStatus::failed || fit.rough || fit.set.empty());
}

void Search::choose_best() {
  std::vector<SetFit*> order;
  for (auto& [set, fit] : sets_)
    if (fit.fit.status != FitStatus::failed || fit.rough || set.empty()) order.push_back(&fit);
  std::ranges::sort(order, {}, [&](const SetFit* fit) { return criterion(*fit); });
  for (std::size_t i = 0; i < order.size(); ++i)
    if (i < kJudged || order[i]->set.empty()) may_be_answer(*order[i]);
  const auto before = best_;
  for (;;) {
    SetFit* most = &sets_.at({});
    for (SetFit* fit : order)
      if (fit->judged && may_be_answer(*fit) && fit->mass_of_both() > most->mass_of_both()) most = fit;
    best_ = most->set;
    if (!most->rough) break;
    finish(*most);
    may_be_answer(*most);
  }
  if (best_ != before) columns_ = columns_at(*problem_, best().fit.point);
}

// A set's fit with only `part` of its effects; one that was tried stays as it is, unless what the others gain
// cannot account for how much worse it is: then it was caught short, and starts again from here.
bool Search::fit_part(const SetFit& whole, const std::vector<std::size_t>& part) {
  const auto known = sets_.find(part);
  if (known != sets_.end()) {
    double others = kWorthAFit;
    const auto& candidates = whole.fit.point.hypothesis.candidates;
    for (std::size_t e = 0; e < candidates.size() && whole.judged; ++e)
      if (!std::ranges::binary_search(part, candidates[e]))
        others += kPromiseShort * whole.evidence.trials[e].gain();
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

// Each effect of the best set against all others in its place.
void Search::exchange() {
  for (int round = 0; round < 3; ++round) {
    const auto before = best_;
    for (const auto candidate : before) {
      const auto rest = without(before, candidate);
      fit_part(SetFit(sets_.at(before)), rest);
      expand(rest, options_.fits_per_screen);
    }
    choose_best();
    if (best_ == before) break;
  }
}

// A null fit may be stuck where one of its effects gets the nuisances out: it starts again from there, or
// what only freed the nuisances would pass for an effect.
void Search::restart_null() {
  for (int round = 0; round < kNullRestarts; ++round) {
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

// Sets that a linear approximation at the best point puts first. True when one was new.
bool Search::try_proposals() {
  const Point from = best().fit.point;
  const double cost = cost_of_an_effect();
  const double explained = null().fit.deviance - best().fit.deviance;
  const double limit = best().fit.deviance + cost * static_cast<double>(best_.size()) +
                       kWorthAFit + kLinearError * explained;
  bool tried = false;
  for (const auto& proposal :
       propose(*problem_, from, options_.most_effects, options_.proposals, cost)) {
    auto set = proposal.start.candidates;
    std::sort(set.begin(), set.end());
    if (proposal.deviance > limit) continue;
    const auto before = sets_.find(set);
    const double promised = proposal.deviance - cost * static_cast<double>(set.size());
    // A fit that was tried may have been caught short of what it can explain.
    if (before != sets_.end() && before->second.fit.deviance < promised + kCaught) continue;
    SetFit fit;
    fit.set = set;
    Point start = from;
    start.hypothesis = proposal.start;
    fit.fit = fit_at(start, {.of_use_below = limit + kRival});
    if (before != sets_.end() && before->second.fit.deviance <= fit.fit.deviance) continue;
    sets_[set] = std::move(fit);
    tried = true;
  }
  if (tried) choose_best();
  return tried;
}

std::optional<std::vector<std::size_t>> Search::likeliest_of_size(std::size_t size) const {
  const SetFit* most = nullptr;
  for (const auto& [set, fit] : sets_)
    if (set.size() == size && fit.judged && (most == nullptr || fit.log_mass > most->log_mass)) most = &fit;
  if (most == nullptr) return std::nullopt;
  return most->set;
}

// Sets without one effect of a set, from where that stands: what only gets a fit out of a valley, or brings a few
// trials nearer, is no effect.
void Search::refit_parts(const std::vector<std::size_t>& set) {
  const SetFit whole = sets_.at(set);
  for (const auto candidate : whole.set) {
    const auto part = without(whole.set, candidate);
    Point start = whole.fit.point;
    Hypothesis h;
    for (std::size_t i = 0; i < start.hypothesis.candidates.size(); ++i)
      if (start.hypothesis.candidates[i] != candidate) {
        h.candidates.push_back(start.hypothesis.candidates[i]);
        h.values.push_back(start.hypothesis.values[i]);
      }
    start.hypothesis = h;
    SetFit fit;
    fit.set = part;
    fit.fit = fit_at(start);
    const auto known = sets_.find(part);
    if (known != sets_.end() && known->second.fit.deviance <= fit.fit.deviance + kWorthAStep) continue;
    judge(fit);
    sets_[part] = std::move(fit);
  }
}

// The likeliest sets with all their parts, until none is likelier that its trials agree on.
void Search::settle_parts() {
  std::set<std::vector<std::size_t>> done;
  for (;;) {
    choose_best();
    const SetFit* likeliest = nullptr;
    for (const auto& [set, fit] : sets_)
      if (fit.judged && !set.empty() && !done.contains(set) && fit.log_mass >= best().log_mass &&
          (likeliest == nullptr || fit.log_mass > likeliest->log_mass))
        likeliest = &fit;
    if (likeliest == nullptr) return;
    done.insert(likeliest->set);
    refit_parts(std::vector(likeliest->set));
  }
}

const SetFit& Search::revise(const Point& null, const std::vector<Point>& seeds, const Signatures& at_best) {
  columns_ = columns_at(*problem_, seeds.front());
  SetFit nothing;
  nothing.fit = fit_at(null, kRough);
  sets_[{}] = std::move(nothing);
  for (const auto& seed : seeds) {
    SetFit fit;
    fit.set = seed.hypothesis.candidates;
    std::sort(fit.set.begin(), fit.set.end());
    fit.rough = true;
    fit.fit = fit_at(seed, kRough);
    sets_[fit.set] = std::move(fit);
  }
  choose_best();
  if (best().set.size() == seeds.front().hypothesis.candidates.size())
    screens_[best_] = screen(*problem_, best().fit.point, columns_for(best_), at_best);
  if (best().set.size() < options_.most_effects) expand(std::vector(best_), options_.fits_per_screen);
  choose_best();
  finish_rivals();
  settle_best();
  settle_parts();
  return best();
}

std::vector<Point> Search::best_points(std::size_t count) const {
  std::vector<const SetFit*> order;
  const double limit = best().fit.deviance + kNearlyAsGood * (null().fit.deviance - best().fit.deviance);
  for (const auto& [set, fit] : sets_)
    if (!set.empty() && fit.fit.status != FitStatus::failed && fit.fit.deviance <= limit)
      order.push_back(&fit);
  std::sort(order.begin(), order.end(),
            [&](const SetFit* a, const SetFit* b) { return criterion(*a) < criterion(*b); });
  // Not those that only add to a better one.
  std::vector<const SetFit*> chosen;
  std::vector<Point> points;
  if (!best_.empty()) order.insert(order.begin(), &best());
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
  sets_[{}] = std::move(null);
  restart_null();
  if (!seeds.empty()) columns_ = columns_at(*problem_, seeds.front());
  for (const auto& seed : seeds) {
    SetFit fit;
    fit.set = seed.hypothesis.candidates;
    std::sort(fit.set.begin(), fit.set.end());
    fit.rough = true;
    fit.fit = fit_at(seed, kRough);
    sets_[fit.set] = std::move(fit);
  }
  std::vector<std::vector<std::size_t>> front{{}};
  for (std::size_t size = 1; size <= options_.most_effects; ++size) {
    // Only beside what comes nearest: it takes as long as a screen and all its fits.
    const SetFit nearest = sets_.at(front.front());
    if (options_.straight && is_bent(nearest.fit)) evaluate_straight(nearest);
    for (std::size_t i = 0; i < front.size(); ++i) {
      options_.progress(
          (static_cast<double>(size - 1) + static_cast<double>(i) / static_cast<double>(front.size())) /
              static_cast<double>(options_.most_effects + 1),
          "trying effects");
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
      if (front.size() < options_.beam &&
          fit->fit.deviance - grown.front()->fit.deviance <= kNearlyAsGood * explained)
        front.push_back(fit->set);
    if (front.empty() || (criterion(*grown.front()) >= smaller && best_ == before)) break;
  }
  borrow(sets_.at({}));
  exchange();
  for (int round = 0; round < 3 && options_.proposals > 0; ++round) {
    const auto so_far = best_;
    if (!try_proposals() || best_ == so_far) break;
  }
  finish_rivals();
  settle_best();
  settle_parts();
  return best();
}

}  // namespace sandhopper::diagnose
