#include "tools/diagnose/search.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "tools/diagnose/left_over.hpp"
#include "tools/diagnose/linearise.hpp"
#include "tools/diagnose/proposals.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kWorthAFit = 6.0;  // drop of the deviance
constexpr double kPriorOfAnEffect = 1.0 / 40.0;
constexpr double kSignificance = 0.01;  // family-wise
constexpr double kTrialsToFlip = 6.0;   // that carry the information: 64 flips
// Of the linear gain at the fit, by how much the fit without the effect is really worse; where a simulation
// amplifies its smallest change, this is nothing while the derivative is huge.
constexpr double kComesTrue = 0.05;
constexpr double kTrialsAgree = 0.01;
constexpr double kMostlyTrue = 0.3;  // or what the trials say of the derivative needs their flips, too
constexpr double kWithoutFlips = 1e-4;
constexpr double kHopeless = 0.2;
constexpr double kBeyondDoubt = 1e-8;
constexpr double kSmallestOfTypical = 0.08;
constexpr double kUnmistakablePerRow = 1.0;  // what gains the noise's own power is not too small to name
constexpr double kSmallestShare = 0.002;     // of what all effects explain
constexpr double kShareOfFormError = 0.2;    // that passes for an effect of its own
constexpr double kLinearError =
    0.05;  // of what is explained: a proposal's estimate may be worse than its fit
// Of the logarithm of a size in typical ones, believed beforehand. Small effects are common; of two that
// nearly cancel, both are many times their typical size.
constexpr double kSpreadBelow = 1.8;
constexpr double kSpreadAbove = 1.0;
constexpr double kCaught = 3.0;         // of the deviance over the dispersion, above what a proposal promises
constexpr double kNearlyAsGood = 0.35;  // of the explained deviance: what an exchange may start from

constexpr FitOptions kRough{
    .max_iterations = 6, .tolerance = 2.0, .refresh = false};  // of sets that are only tried
constexpr double kRival = 20.0;                                // of the criterion
constexpr double kPromiseShort = 1.5;  // a linear estimate of a drop may be short by so much
constexpr int kNullRestarts = 3;
constexpr std::size_t kFitsToFreeNull = 2;
constexpr double kFreed = 0.02;      // of a drop that the null fit finds, too
constexpr double kBentPerRow = 1.5;  // deviance from which nuisances are not what they are believed to be
constexpr double kBentLean = 4.0;    // or all trials move one of them alike; with nothing missing up to 3.4
constexpr double kUnbent = 0.6;      // of a lean that is left
constexpr std::size_t kStraightFits = 3;
constexpr std::array kCommonSizes{0.5, 2.0, -0.5, -2.0};  // in typical ones

std::vector<std::size_t> with(std::vector<std::size_t> set, std::size_t candidate) {
  set.push_back(candidate);
  std::sort(set.begin(), set.end());
  return set;
}

std::vector<std::size_t> without(std::vector<std::size_t> set, std::size_t candidate) {
  set.erase(std::remove(set.begin(), set.end(), candidate), set.end());
  return set;
}

// The largest amplitude of one effect, in typical sizes.
double typicals_of(const Problem& problem, const Hypothesis& hypothesis, std::size_t e) {
  const auto& parameters = problem.candidates[hypothesis.candidates[e]].parameters;
  double typicals = 0.0;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (is_amplitude(parameters, i))
      typicals = std::max(typicals, parameters[i].typicals(hypothesis.values[e][i]));
  return typicals;
}

// Minus twice the logarithm of how likely these sizes were beforehand.
double size_deviance(const Problem& problem, const Hypothesis& hypothesis) {
  double sum = 0.0;
  for (std::size_t e = 0; e < hypothesis.candidates.size(); ++e) {
    const double size = std::log(std::max(typicals_of(problem, hypothesis, e), 1e-3));
    sum += std::pow(size / (size < 0.0 ? kSpreadBelow : kSpreadAbove), 2);
  }
  return sum;
}

// Whether every effect is large enough to be worth another beside it.
bool worth_growing(const Problem& problem, const Hypothesis& hypothesis) {
  for (std::size_t e = 0; e < hypothesis.candidates.size(); ++e)
    if (typicals_of(problem, hypothesis, e) < 0.5 * kSmallestOfTypical) return false;
  return true;
}

// How far this effect moves channels in time. The tolerances of those channels do the same and would leave
// the trials nothing to say.
std::map<std::string, double> delays_s(const Problem& problem, const Hypothesis& hypothesis, std::size_t e) {
  const auto& candidate = problem.candidates[hypothesis.candidates[e]];
  Edits edits;
  candidate.effect->apply(problem.context, candidate.channel, hypothesis.values[e], edits);
  std::map<std::string, double> delays;
  for (const auto& edit : edits.sensors)
    if (edit.kind == SensorEdit::Kind::delay_s) delays[edit.channel] += edit.value;
  return delays;
}

// Whether all it does is to move channels by no more than their times are unsure; that of a recorded input is
// as unsure as that of the channel whose samples come slowest.
bool within_tolerance(const Problem& problem, const std::map<std::string, double>& delays) {
  if (delays.empty() || problem.tolerances.empty()) return false;
  if (!problem.plant->drive_is_recorded() && delays.contains("actuator")) return false;
  double slowest_s = 0.0;
  for (const auto& tolerance : problem.tolerances) slowest_s = std::max(slowest_s, tolerance.of_sampling);
  return std::ranges::all_of(delays, [&](const auto& delay) {
    double scale_s = slowest_s;
    for (const auto& tolerance : problem.tolerances)
      if (tolerance.channel == delay.first) scale_s = tolerance.scale;
    return std::abs(delay.second) <= kMostTolerance * scale_s;
  });
}

// Several channels that are late by the same: none is, against the others.
bool late_together(const Problem& problem, const Hypothesis& hypothesis) {
  std::map<std::string, double> delays;
  for (std::size_t e = 0; e < hypothesis.candidates.size(); ++e)
    for (const auto& [channel, delay_s] : delays_s(problem, hypothesis, e)) delays[channel] += delay_s;
  if (delays.size() < 2) return false;
  const double first_s = delays.begin()->second;
  for (auto& [channel, delay_s] : delays) delay_s -= first_s;
  return within_tolerance(problem, delays);
}

// Channels whose readings it changes; empty where it changes what happens, too.
std::vector<std::string> channels_read(const Problem& problem, const Hypothesis& hypothesis, std::size_t e) {
  const auto& candidate = problem.candidates[hypothesis.candidates[e]];
  Edits edits;
  candidate.effect->apply(problem.context, candidate.channel, hypothesis.values[e], edits);
  std::vector<std::string> channels;
  for (const auto& edit : edits.sensors) {
    if (!problem.context.channels.contains(edit.channel) || edit.channel.ends_with("position_rad")) return {};
    channels.push_back(edit.channel);
  }
  if (!edits.belief.empty() || !edits.laws.empty()) channels.clear();
  return channels;
}

// Whether the fit without an effect is really worse: by a part of what the linear gain says, or else trial by
// trial.
bool comes_true(const Fit& without, const Fit& with, double linear_gain) {
  if (without.deviance - with.deviance > kComesTrue * linear_gain) return true;
  std::vector<double> drops;
  for (std::size_t t = 0; t < with.trial_deviance.size(); ++t)
    drops.push_back(without.trial_deviance[t] - with.trial_deviance[t]);
  return signed_rank_p_value(drops) < kTrialsAgree;
}

}  // namespace

double Search::cost_of_an_effect() const { return -2.0 * std::log(kPriorOfAnEffect) + cost_of_a_parameter(); }

double Search::cost_of_a_parameter() const {
  return std::log(std::max<double>(3.0, static_cast<double>(problem_->trials.size())));
}

double Search::criterion(const SetFit& fit) const {
  const auto effects = static_cast<double>(fit.set.size());
  const auto parameters = static_cast<double>(fit.fit.point.hypothesis.parameters());
  return fit.fit.deviance / dispersion_ + size_deviance(*problem_, fit.fit.point.hypothesis) +
         effects * cost_of_an_effect() + (parameters - effects) * cost_of_a_parameter();
}

const std::vector<Screened>& Search::screened(const std::vector<std::size_t>& set) {
  const auto it = screens_.find(set);
  if (it != screens_.end()) return it->second;
  return screens_[set] = screen(*problem_, sets_.at(set).fit.point, columns_for(set));
}

void Search::judge(SetFit& result) {
  const Point& point = result.fit.point;
  const auto directions = parameter_directions(*problem_, point);
  const auto linear = linearise_all(*problem_, point, directions, {.columns = columns_for(result.set)});
  const auto k = static_cast<Index>(directions.size());
  const auto parameters = static_cast<Index>(point.hypothesis.parameters());
  const VectorXd prior = prior_information(*problem_, point);
  double dispersion = 0.0, count = 0.0;
  Index first = 1;
  result.evidence.clear();
  result.judged = true;
  result.needed = result.sound = true;
  result.hopeless = false;
  for (std::size_t e = 0; e < point.hypothesis.candidates.size(); ++e) {
    const auto& candidate = problem_->candidates[point.hypothesis.candidates[e]];
    const auto width = static_cast<Index>(candidate.parameters.size());
    // The first amplitude of this effect, with its other parameters and everything else eliminated; shapes of
    // an effect do not shelter others.
    std::vector<TrialLinear> reordered = linear;
    std::vector<Index> order{0, first};
    std::vector<double> amplitudes;
    std::vector<Index> amplitude_columns;
    for (Index i = 0; i < width; ++i) {
      const auto& p = candidate.parameters[static_cast<std::size_t>(i)];
      if (is_amplitude(candidate.parameters, static_cast<std::size_t>(i))) {
        amplitude_columns.push_back(first + i);
        amplitudes.push_back(point.hypothesis.values[e][static_cast<std::size_t>(i)] / p.typical);
      }
    }
    const auto delays = delays_s(*problem_, point.hypothesis, e);
    std::vector<Index> others;
    for (Index i = 1; i <= k; ++i) {
      const bool own = i >= first && i < first + width;
      const bool same_as_own =
          i > parameters &&
          delays.contains(problem_->tolerances[static_cast<std::size_t>(i - 1 - parameters)].channel);
      if (!own && !same_as_own) others.push_back(i);
    }
    const auto n_own = static_cast<Index>(amplitude_columns.size());
    const auto n_others = static_cast<Index>(others.size());
    VectorXd others_prior(n_others);
    for (Index i = 0; i < n_others; ++i) others_prior[i] = prior[others[static_cast<std::size_t>(i)] - 1];
    for (auto& trial : reordered) {
      MatrixXd gram(1 + n_own + n_others, 1 + n_own + n_others);
      std::vector<Index> columns{0};
      columns.insert(columns.end(), amplitude_columns.begin(), amplitude_columns.end());
      columns.insert(columns.end(), others.begin(), others.end());
      for (Index i = 0; i < gram.rows(); ++i)
        for (Index j = 0; j < gram.cols(); ++j)
          gram(i, j) = trial.gram(columns[static_cast<std::size_t>(i)], columns[static_cast<std::size_t>(j)]);
      // Put the effect back into the residual: column 0 becomes what is there without it.
      VectorXd back = VectorXd::Zero(gram.rows());
      back[0] = 1.0;
      for (Index i = 0; i < n_own; ++i) back[1 + i] = amplitudes[static_cast<std::size_t>(i)];
      const VectorXd column = gram * back;
      const double corner = back.dot(column);
      gram.col(0) = column;
      gram.row(0) = column.transpose();
      gram(0, 0) = corner;
      trial.gram = gram;
    }
    const auto grams = eliminated(reordered, 1 + n_own, n_others, others_prior);
    std::vector<Index> own;
    for (Index i = 0; i < n_own; ++i) own.push_back(1 + i);
    const auto group = group_gain(grams, own, 0.01);
    EffectEvidence evidence;
    evidence.candidate = point.hypothesis.candidates[e];
    evidence.evidence = group.evidence;
    evidence.gain = group.gain;
    evidence.typicals = typicals_of(*problem_, point.hypothesis, e);
    evidence.p_value =
        std::min(1.0, group.evidence.p_value() * static_cast<double>(problem_->candidates.size()));
    for (std::size_t i = 0; i < candidate.parameters.size(); ++i) {
      const auto& p = candidate.parameters[i];
      const double value = point.hypothesis.values[e][i];
      evidence.at_bound = evidence.at_bound || (p.other_law_above && value >= 0.99 * p.high) ||
                          (is_amplitude(candidate.parameters, i) &&
                           (value >= p.high - 1e-9 * std::abs(p.high) ||
                            (value <= p.low + 1e-9 * std::abs(p.low) && p.low != 0.0)));
    }
    if (within_tolerance(*problem_, delays)) result.sound = false;
    const double model = std::max(1e-300, [&] {
      double s = 0.0;
      for (const double i : group.evidence.information) s += i;
      return s;
    }());
    const double robust = std::pow(group.evidence.standard_error() * model, 2);
    dispersion += robust / model;
    ++count;
    result.evidence.push_back(std::move(evidence));
    first += width;
  }
  if (late_together(*problem_, point.hypothesis)) result.sound = false;
  result.dispersion = count > 0.0 ? std::max(1.0, dispersion / count) : 1.0;
  const double explained = with_form_unnoticed(*problem_, null().fit.deviance - result.fit.deviance);
  const double least_share = std::max(kSmallestShare, kShareOfFormError * problem_->plant->form_error());
  for (std::size_t e = 0; e < result.evidence.size(); ++e) {
    auto& evidence = result.evidence[e];
    const auto parent = without(result.set, evidence.candidate);
    const auto fitted = sets_.find(parent);
    const bool came_true = fitted == sets_.end() || comes_true(fitted->second.fit, result.fit, evidence.gain);
    // Signs are flipped at the set without this effect, against all candidates there.
    if (screens_.contains(parent)) {
      std::vector<TrialEvidence> rivals;
      std::size_t chosen = 0;
      for (const auto& s : screened(parent)) {
        if (s.candidate == evidence.candidate) chosen = rivals.size();
        rivals.push_back(s.evidence);
      }
      if (!rivals.empty()) evidence.flip_p_value = sign_flip_p_value(rivals, chosen, 1);
    } else {
      evidence.flip_p_value = 0.0;
    }
    // Flips are made where the simulation is linear in nothing yet; what the trials say this clearly at the
    // fit itself does not need them. Nor can they say much where a few trials carry nearly all information.
    const bool flips_can_tell = evidence.evidence.effective_trials() >= kTrialsToFlip;
    const bool beyond_doubt =
        evidence.p_value < (flips_can_tell ? kBeyondDoubt : kWithoutFlips) &&
        (fitted == sets_.end() || unbends(fitted->second.fit, result.fit) ||
         fitted->second.fit.deviance - result.fit.deviance > kMostlyTrue * evidence.gain);
    const double flip_needed = problem_->trials.size() >= 6 && !beyond_doubt ? 0.05 : 1.0;
    const double smallest = evidence.gain > kUnmistakablePerRow * problem_->rows() ? 0.0 : kSmallestOfTypical;
    evidence.too_small = evidence.typicals < smallest;
    if (!(evidence.p_value < kSignificance) || evidence.flip_p_value > flip_needed || evidence.at_bound ||
        !came_true)
      result.sound = false;
    // A law of another form may leave as much; where only readings change, of what those channels show.
    if (result.sound && evidence.gain < least_share * explained) {
      const auto read = channels_read(*problem_, point.hypothesis, e);
      result.sound =
          !read.empty() &&
          evidence.gain >= least_share * with_form_unnoticed(
                                             *problem_, deviance_of(*problem_, null().fit.point, read) -
                                                            deviance_of(*problem_, result.fit.point, read));
    }
    result.needed = result.needed && result.sound && !evidence.too_small;
    if (evidence.p_value > kHopeless || evidence.typicals < 0.5 * smallest) result.hopeless = true;
  }
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
  result.fit = fit_at(start, kRough);
  // A second start where the first got nowhere near what its linear approximation promised, if that would
  // pay.
  if (options_.second_starts && from.fit.deviance - result.fit.deviance < 0.5 * added.gain &&
      added.gain > cost_of_an_effect() * dispersion_) {
    const auto& parameters = problem_->candidates[added.candidate].parameters;
    for (const double factor : {0.3, 1.0, -1.0}) {
      if (factor < 0.0 && !parameters[0].either_sign) continue;
      auto values = added.values;
      values[0] = std::clamp(factor * parameters[0].typical, parameters[0].low, parameters[0].high);
      start.hypothesis.values.back() = values;
      Fit again = fit_at(start, kRough);
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
    Fit again = fit_at(start, kRough);
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
  straight.tolerances = from.fit.point.tolerances;
  const auto columns = columns_at(*problem_, straight);
  struct Nearest {
    Point start;
    double deviance = 0.0;  // with the nuisances as a linear approximation has them
  };
  std::map<std::size_t, Nearest> nearest;  // of each candidate
  const auto hold = [&](std::size_t candidate, const std::vector<double>& values) {
    Nearest one{straight, 0.0};
    one.start.hypothesis.candidates.push_back(candidate);
    one.start.hypothesis.values.push_back(values);
    for (const auto& trial : linearise_all(*problem_, one.start, {}, {.columns = &columns}))
      one.deviance += trial.gram(0, 0);
    const auto known = nearest.find(candidate);
    if (known == nearest.end() || one.deviance < known->second.deviance)
      nearest.insert_or_assign(candidate, std::move(one));
  };
  for (const auto& added : screen(*problem_, straight, &columns)) hold(added.candidate, added.values);
  for (std::size_t c = 0; c < problem_->candidates.size(); ++c) {
    if (straight.hypothesis.contains(c)) continue;
    const auto& p = problem_->candidates[c].parameters[0];
    for (auto values : shape_choices(problem_->candidates[c]))
      for (const double typicals : kCommonSizes) {
        values[0] = typicals * p.typical;
        if ((typicals > 0.0 || p.either_sign) && values[0] >= p.low && values[0] <= p.high) hold(c, values);
      }
  }
  std::vector<const Nearest*> order;
  for (const auto& [candidate, one] : nearest) order.push_back(&one);
  std::ranges::sort(order, {}, &Nearest::deviance);
  for (std::size_t i = 0; i < kStraightFits && i < order.size(); ++i) {
    SetFit result;
    result.set = with(from.set, order[i]->start.hypothesis.candidates.back());
    result.fit = fit_at(order[i]->start, {.columns = &columns});  // nuisances have far to go: no rough fit
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
  const auto candidates = screened(from);
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
  options.tolerance *= dispersion_;  // a gain counts by what it is between trials
  return fit_from(*problem_, start, options);
}

void Search::finish(SetFit& fit) const {
  if (!fit.rough) return;
  fit.fit = fit_at(Point(fit.fit.point));
  fit.rough = fit.judged = false;
}

// What competes with the best must not lose only because it was fitted roughly and stopped short of what it
// might explain.
void Search::finish_rivals() {
  const double limit = criterion(best()) + kRival;
  for (auto& [set, fit] : sets_)
    if (set.size() <= best_.size() && criterion(fit) - kPromiseShort * fit.fit.promised / dispersion_ < limit)
      finish(fit);
}

namespace {

std::vector<std::size_t> named_part(const SetFit& fit) {
  std::vector<std::size_t> part;
  for (const auto& evidence : fit.evidence)
    if (!evidence.too_small) part.push_back(evidence.candidate);
  std::ranges::sort(part);
  return part;
}

}  // namespace

void Search::choose_best() {
  // The closest fit first; only sets that can still win are judged.
  std::vector<SetFit*> order;
  for (auto& [set, fit] : sets_)
    if (fit.fit.status != FitStatus::failed || fit.rough || set.empty()) order.push_back(&fit);
  std::sort(order.begin(), order.end(),
            [](const SetFit* a, const SetFit* b) { return a->fit.deviance < b->fit.deviance; });
  const auto needed = [&](SetFit& fit) {
    if (!fit.judged) judge(fit);
    // A rough fit that is far from needing its effects is not worth a better one.
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
  std::vector<const SetFit*> trivial;  // better sets, something in which is too small to be named
  for (auto* fit : order) {
    if (needed(*fit)) {
      best_ = fit->set;
      break;
    }
    if (fit->judged && fit->sound) trivial.push_back(fit);
  }
  // What an effect too small to be named explains clearly better is no finding.
  for (const auto* fit : trivial) {
    const auto part = named_part(*fit);
    if (part.size() < best_.size() && std::ranges::includes(best_, part) && sets_.contains(part) &&
        criterion(*fit) + kWorthAFit < criterion(best()) && needed(sets_.at(part)))
      best_ = part;
  }
  if (best_ != before) columns_ = columns_at(*problem_, best().fit.point);
}

// A set's fit with only `part` of its effects; one that was tried stays as it is, unless what the others gain
// cannot account for how much worse it is: then it was caught short, and starts again from here.
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

// Sets that fit better than the best but hold an effect they do not need: what is left without it may be the
// answer, although no forward step led there.
void Search::prune() {
  for (int round = 0; round < 3; ++round) {
    std::vector<const SetFit*> order;
    for (const auto& [set, fit] : sets_)
      if (fit.judged && !fit.needed && fit.fit.deviance <= best().fit.deviance) order.push_back(&fit);
    std::ranges::sort(order, {}, [](const SetFit* fit) { return fit->fit.deviance; });
    std::map<std::vector<std::size_t>, SetFit> wholes;  // the closest that holds each part
    for (const auto* fit : order) {
      std::vector<std::size_t> part;
      for (const auto& evidence : fit->evidence)
        if (evidence.p_value < kSignificance && !evidence.too_small) part.push_back(evidence.candidate);
      std::sort(part.begin(), part.end());
      if (!part.empty() && part.size() < fit->set.size()) wholes.emplace(part, *fit);
    }
    bool tried = false;
    for (const auto& [part, whole] : wholes) tried = fit_part(whole, part) || tried;
    if (!tried) return;
    choose_best();
  }
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
    if (options_.straight && is_bent(null().fit)) evaluate_straight(SetFit(null()));
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
  const double limit = best().fit.deviance + cost * dispersion_ * static_cast<double>(best_.size()) +
                       kWorthAFit + kLinearError * explained;
  bool tried = false;
  for (const auto& proposal :
       propose(*problem_, from, options_.most_effects, options_.proposals, cost * dispersion_)) {
    auto set = proposal.start.candidates;
    std::sort(set.begin(), set.end());
    if (proposal.deviance > limit) continue;
    const auto before = sets_.find(set);
    const double promised = proposal.deviance - cost * dispersion_ * static_cast<double>(set.size());
    // A fit that was tried may have been caught short of what it can explain.
    if (before != sets_.end() && before->second.fit.deviance < promised + kCaught * dispersion_) continue;
    SetFit fit;
    fit.set = set;
    Point start = from;
    start.hypothesis = proposal.start;
    fit.fit = fit_at(start);
    if (before != sets_.end() && before->second.fit.deviance <= fit.fit.deviance) continue;
    sets_[set] = std::move(fit);
    tried = true;
  }
  if (tried) choose_best();
  return tried;
}

std::vector<Point> Search::best_points(std::size_t count) const {
  std::vector<const SetFit*> order;
  for (const auto& [set, fit] : sets_)
    if (!set.empty() && fit.fit.status != FitStatus::failed) order.push_back(&fit);
  std::sort(order.begin(), order.end(),
            [&](const SetFit* a, const SetFit* b) { return criterion(*a) < criterion(*b); });
  std::vector<Point> points;
  for (std::size_t i = 0; i < order.size() && i < count; ++i) points.push_back(order[i]->fit.point);
  return points;
}

const SetFit& Search::run(const Point& start, const std::vector<Point>& seeds) {
  sets_.clear();
  screens_.clear();
  straight_.clear();
  SetFit null;
  null.fit = fit_at(start);
  null.needed = null.judged = true;
  sets_[{}] = std::move(null);
  restart_null();
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
      if (front.size() < options_.beam && worth_growing(*problem_, fit->fit.point.hypothesis) &&
          fit->fit.deviance - grown.front()->fit.deviance <= kNearlyAsGood * explained)
        front.push_back(fit->set);
    if (front.empty() || (criterion(*grown.front()) >= smaller && best_ == before)) break;
  }
  exchange();
  const auto before = best_;
  prune();
  if (best_ != before) exchange();
  for (int round = 0; round < 3 && options_.proposals > 0; ++round) {
    const auto so_far = best_;
    if (!try_proposals() || best_ == so_far) break;
    prune();
  }
  finish_rivals();
  return best();
}

}  // namespace sandhopper::diagnose
