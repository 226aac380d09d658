#include "tools/diagnose/next/next_trial.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <set>

#include "tools/diagnose/evidence/rivals.hpp"
#include "tools/diagnose/fit/statistics.hpp"
#include "tools/diagnose/model/digits.hpp"
#include "tools/diagnose/model/quantity.hpp"
#include "tools/diagnose/next/bench_test.hpp"
#include "tools/diagnose/next/choice.hpp"
#include "tools/diagnose/next/none_planned.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// The limits of this file were set by hand.
constexpr double kNarrow = 0.5;  // A bound below this fraction of the typical size is narrow enough.
// Smallest worth of a recommended trial, in doublings of the information.
constexpr double kWorthATrial = 0.2;
constexpr double kASession = 10.0;  // Largest number of repeats that is still recommended.
// Largest ratio that counts: gain of a trial / gain that separates two explanations.
constexpr double kEnoughGain = 10.0;
// Number of points of a predicted trace.
constexpr std::size_t kMostPoints = 400;

// Stores the two predictions of the channel in which they differ most relative to the noise.
void show(const Problem& problem, const TrialModel& model, const Contest::Predictions& at, NextTrial& next) {
  std::vector<double> energy(problem.channels.size(), 0.0);
  double most = 0.0;
  std::size_t where = 0;
  for (std::size_t k = 0; k < model.rows.size(); ++k) {
    const Row& row = model.rows[k];
    const double apart =
        std::abs(at.second[k] - at.first[k]) / problem.noise.channel(row.channel).sd_of_phase[row.phase];
    energy[row.channel] += apart * apart;
  }
  const auto channel =
      static_cast<std::uint32_t>(std::max_element(energy.begin(), energy.end()) - energy.begin());
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < model.rows.size(); ++k) {
    if (model.rows[k].channel != channel) continue;
    rows.push_back(k);
    if (const double apart = std::abs(at.second[k] - at.first[k]); apart >= most) {
      most = apart;
      where = k;
    }
  }
  if (rows.empty()) return;
  next.channel = problem.channels[channel];
  next.noise = problem.noise.channel(channel).sd();
  const std::size_t step = (rows.size() + kMostPoints - 1) / kMostPoints;
  for (std::size_t i = 0; i < rows.size(); i += step) {
    next.time_s.push_back(model.rows[rows[i]].time_s);
    next.by_first.push_back(at.first[rows[i]]);
    next.by_second.push_back(at.second[rows[i]]);
  }
  const Row& row = model.rows[where];
  const double apart = std::abs(at.second[where] - at.first[where]);
  const auto unit = quantity_of(next.channel).unit;
  next.why = fmt::format(
      "{} at {:.3g} s ({}): {} predicts {} {}, {} predicts {} {}; that is {} {} apart, with a noise of {} "
      "{}.",
      next.channel, row.time_s, in_words(problem.phases[row.phase]), next.first,
      to_digits_of(at.first[where], apart), unit, next.second, to_digits_of(at.second[where], apart), unit,
      plain_number(apart, 2), unit, plain_number(next.noise, 2), unit);
}

// Two rivals i, j of one group.
struct Pair {
  std::size_t group, i, j;
};
std::vector<Pair> pairs_of(const std::vector<Rivals>& groups) {
  std::vector<Pair> pairs;
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (std::size_t i = 0; i < groups[g].size(); ++i)
      for (std::size_t j = i + 1; j < groups[g].size(); ++j) pairs.push_back({g, i, j});
  return pairs;
}

// "split": the trial that separates the rivals best.
void split(const Problem& problem, const PlannedTrials& planned, const Search& search,
           const Posterior& belief, const std::vector<Rivals>& groups, NextTrial& next) {
  const auto pairs = pairs_of(groups);
  const auto contests = [&](std::size_t trial) {
    std::vector<Contest> all;
    for (const auto& rivals : groups) all.emplace_back(problem, planned, trial, rivals, search.dispersion());
    return all;
  };
  // The limit grows with the deviance to explain, because simulation errors grow with it.
  const auto apart = [&](const Contest& one) {
    return belief.apart + belief.apart_per_explained * one.explained();
  };
  const auto choice = best_of(planned, [&](std::size_t trial) {
    const auto all = contests(trial);
    std::vector<double> needed;
    for (const auto& one : all) needed.push_back(apart(one));
    double sum = 0.0;
    for (const auto& p : pairs)
      sum += std::log2(1.0 + std::min(all[p.group].lambda(p.i, p.j) / needed[p.group], kEnoughGain));
    return sum / static_cast<double>(pairs.size());
  });
  const auto all = contests(choice.trial);
  take(planned[choice.trial], "split", next);
  std::string chances;
  Pair shown = pairs.front();
  double most = -1.0;
  next.settles = 1.0;
  for (const auto& p : pairs) {
    const double chance = all[p.group].settles(p.i, p.j, apart(all[p.group]));
    const double lambda = all[p.group].lambda(p.i, p.j);
    next.settles = std::min(next.settles, chance);
    next.splits = std::max(next.splits, chance);
    // Show the found effect and the rival from which this trial separates it best.
    if (p.i == 0 && lambda > most) {
      most = lambda;
      shown = p;
    }
    if (p.i == 0)
      chances += fmt::format("{}{} {:.2f}", chances.empty() ? "" : ", ", groups[p.group].names[p.j], chance);
  }
  next.first = groups[shown.group].names[shown.i];
  next.second = groups[shown.group].names[shown.j];
  show(problem, planned.model(choice.trial), all[shown.group].predictions(problem, planned, shown.i, shown.j),
       next);
  next.why += fmt::format(" Chance that one such trial distinguishes it from {}.", chances);
  if (next.splits >= 0.5) return;
  const double repeats = std::ceil(1.5 * apart(all[shown.group]) / std::max(most, 1e-3));
  if (repeats <= kASession) {
    next.why += fmt::format(" About {:.0f} of them would do so.", repeats);
    return;
  }
  std::string others;
  std::set<std::string> named;
  for (const auto& p : pairs)
    if (const auto& name = groups[p.group].names[p.j]; p.i == 0 && named.insert(name).second)
      others += (others.empty() ? "" : ", ") + name;
  next = {};
  next.why = fmt::format(
      "None: no single one of {} possible trials distinguishes {} from {}; the best would have to be "
      "repeated about {:.0f} times.",
      planned.size(), groups[shown.group].names[0], others, repeats);
}

// Mean over the parameters `of` of log2(variance before / variance after the trial). `information`: so far.
double sharpening(const MatrixXd& information, const MatrixXd& added, const std::vector<Index>& of) {
  const auto n = information.rows();
  const MatrixXd before = information.ldlt().solve(MatrixXd::Identity(n, n));
  const MatrixXd after = MatrixXd(information + added).ldlt().solve(MatrixXd::Identity(n, n));
  double sum = 0.0;
  for (const Index i : of) sum += std::log2(std::max(before(i, i), 1e-300) / std::max(after(i, i), 1e-300));
  return of.empty() ? 0.0 : sum / static_cast<double>(of.size());
}

// "sharpen": the trial that reduces the variances of the found effects most.
void sharpen(const Problem& problem, const PlannedTrials& planned, const Search& search,
             const Diagnosis& diagnosis, NextTrial& next) {
  const SetFit& best = search.best();
  const Point& point = best.fit.point;
  const auto directions = plain_directions(problem, point);
  const auto k = static_cast<Index>(directions.size());
  const Edits base = edits_for(problem, point.hypothesis, point.tolerances);
  std::vector<Index> amplitudes;
  Index at = 0;
  for (const auto c : point.hypothesis.candidates)
    for (std::size_t j = 0; j < problem.candidates[c].parameters.size(); ++j, ++at)
      if (j == 0) amplitudes.push_back(at);
  const auto choice = best_of(planned, [&](std::size_t i) {
    const MatrixXd added = planned.linearised(i, base, directions).gram.bottomRightCorner(k, k);
    return sharpening(best.fit.information, added, amplitudes);
  });
  if (choice.worth < kWorthATrial) {
    next.why =
        "None needed to name the effect: no single trial narrows the intervals by more than a few per cent.";
    return;
  }
  take(planned[choice.trial], "sharpen", next);
  next.why =
      fmt::format("Narrows the interval{} of {} to {:.0f} % of {} width; an average trial, to {:.0f} %.",
                  amplitudes.size() > 1 ? "s" : "",
                  diagnosis.effects.size() > 1 ? "what was found" : diagnosis.effects.front().id,
                  100.0 * std::exp2(-0.5 * choice.worth), amplitudes.size() > 1 ? "their" : "its",
                  100.0 * std::exp2(-0.5 * median(choice.all)));
}

// "map": the trial that reduces the variances of a free law's knots most.
void map_further(const Problem& problem, const PlannedTrials& planned, const Search& search,
                 const FreeGain& rest, NextTrial& next) {
  const Point& point = search.best().fit.point;
  const Edits base = edits_for(problem, point.hypothesis, point.tolerances);
  constexpr double kProbe = 0.2;  // step of the derivatives, in scales of the port
  std::vector<Direction> directions;
  for (const auto& term : rest.family.terms) directions.push_back({with_term(base, term, kProbe), kProbe});
  const auto k = static_cast<Index>(directions.size());
  MatrixXd information = MatrixXd::Identity(k, k) * kFreeLawInformation;
  for (Index i = 0; i < k; ++i)
    information(i, i) = std::max(kFreeLawInformation, 1.0 / std::pow(rest.sd[i], 2));
  std::vector<Index> knots(static_cast<std::size_t>(k));
  for (Index i = 0; i < k; ++i) knots[static_cast<std::size_t>(i)] = i;
  const auto choice = best_of(planned, [&](std::size_t i) {
    return sharpening(information, planned.linearised(i, base, directions).gram.bottomRightCorner(k, k),
                      knots);
  });
  take(planned[choice.trial], "map", next);
  const auto width = [](double worth) { return std::round(100.0 * std::exp2(-0.5 * worth)); };
  const double best = width(choice.worth), usual = width(median(choice.all));
  next.why = fmt::format(
      "Measures what acts at {} better: its band along {} narrows to {:.0f} % of its width, {}.",
      rest.family.port, rest.family.variable, best,
      best < usual ? fmt::format("with an average trial to {:.0f} %", usual) : "as with any other trial");
}

// "bound": the trial that reduces the widest bound most. Candidates that the recordings do not bound at all
// are left out.
void bound_closer(const Problem& problem, const PlannedTrials& planned, Search& search, bool few,
                  NextTrial& next) {
  const auto& screened = search.screened(search.best().set);
  const Screened* widest = nullptr;
  double typicals = 0.0;
  for (const auto& s : screened) {
    const double bound = std::abs(s.evidence.size()) + 2.0 * s.evidence.standard_error();
    if (bound < 1e6 && bound > typicals) {
      typicals = bound;
      widest = &s;
    }
  }
  if (widest == nullptr) return;
  const Candidate& candidate = problem.candidates[widest->candidate];
  if (!few && typicals < kNarrow) {
    next.why = fmt::format(
        "None needed: each effect by itself is excluded (95 %) beyond {} times its typical size.", kNarrow);
    return;
  }
  const Point& point = search.best().fit.point;
  Hypothesis with = point.hypothesis;
  constexpr double kProbe = 0.4;  // step of the derivative, in typical sizes
  std::vector<double> values;
  for (std::size_t i = 0; i < candidate.parameters.size(); ++i)
    values.push_back(i == 0 ? std::min(kProbe * candidate.parameters[0].typical, candidate.parameters[0].high)
                     : candidate.parameters[i].amplitude ? 0.0
                                                         : candidate.parameters[i].typical);
  with.candidates.push_back(widest->candidate);
  with.values.push_back(values);
  auto directions = plain_directions(problem, point);
  directions.push_back(
      {edits_for(problem, with, point.tolerances), values[0] / candidate.parameters[0].typical});
  const auto k = static_cast<Index>(directions.size());
  double known = 0.01;
  for (const double one : widest->evidence.information) known += one;
  MatrixXd information = MatrixXd::Zero(k, k);
  information.topLeftCorner(k - 1, k - 1) = search.best().fit.information;
  information(k - 1, k - 1) = known;
  const Edits base = edits_for(problem, point.hypothesis, point.tolerances);
  const auto choice = best_of(planned, [&](std::size_t i) {
    return sharpening(information, planned.linearised(i, base, directions).gram.bottomRightCorner(k, k),
                      {k - 1});
  });
  if (!few && choice.worth < kWorthATrial) {
    next.why = fmt::format("None: no trial like these would exclude more. The widest bound is that of {}.",
                           candidate.label());
    return;
  }
  take(planned[choice.trial], "bound", next);
  next.why = fmt::format("{} widest bound is that of {}; this trial narrows it to {} % of its width.",
                         few ? "At least five trials are needed to know how far they repeat. The" : "The",
                         candidate.label(), plain_number(100.0 * std::exp2(-0.5 * choice.worth), 2));
}

// "repeat": one of the recorded trials, after the faulty sensor was repaired.
void record_again(const Recordings& recordings, const Diagnosis& diagnosis, NextTrial& next) {
  const Trial& first = recordings.trials.front();
  next.purpose = "repeat";
  next.kind = first.kind;
  next.setup = first.setup;
  next.setup.erase("session");
  next.order = trial_in_words(next.kind, {}, next.setup, Telling::order);
  next.why = fmt::format("again as recorded, after a repair of {}. The fault must not appear again.",
                         diagnosis.effects.front().channel);
}

// All that the choice of a next trial depends on, besides the reach of the lab.
struct Question {
  Problem& problem;
  const Recordings& recordings;
  Search& search;
  const Posterior& belief;
  const std::vector<Rivals>& rivals;
  const FreeGain* rest;
  const Diagnosis& diagnosis;
};

// Set-ups of the trials that were compared.
using Setups = std::vector<std::pair<std::map<std::string, double>, std::map<std::string, std::string>>>;

// Proposes the trial with the largest worth among those within `reach`. Leaves `next` unchanged if their
// set-ups are the `compared` ones, to which no wider reach adds anything.
void propose_within(const Reach& reach, const Question& q, Setups& compared, NextTrial& next) {
  const Point& point = q.search.best().fit.point;
  const Edits edits = edits_for(q.problem, point.hypothesis, point.tolerances);
  const PlannedTrials planned(
      q.problem, q.problem.plant->doable(q.recordings.trials, q.recordings.belief, edits, reach));
  Setups setups;
  for (std::size_t i = 0; i < planned.size(); ++i)
    setups.emplace_back(planned[i].trial.setup, planned[i].words);
  if (planned.size() > 0 && setups == compared) return;
  compared = std::move(setups);
  if (planned.size() == 0) {
    next.why = why_none_is_planned(q.problem.context.plant, reach, planned.refusal());
    return;
  }
  if (!q.diagnosis.unknown.empty() && q.rest != nullptr)
    map_further(q.problem, planned, q.search, *q.rest, next);
  else if (q.search.best().set.empty())
    bound_closer(q.problem, planned, q.search, q.diagnosis.verdict == Verdict::insufficient_data, next);
  else if (!q.rivals.empty())
    split(q.problem, planned, q.search, q.belief, q.rivals, next);
  else
    sharpen(q.problem, planned, q.search, q.diagnosis, next);
}

// No trial within reach splits a class: another set-up that any lab can make, else a test on the bench.
void look_further(const Reach& reach, const Question& q, Setups& compared, NextTrial& next) {
  NextTrial further;
  propose_within(reach.with_free_numbers(), q, compared, further);
  if (further.is_recommended()) {
    next = std::move(further);
    next.beyond_recorded = true;
    return;
  }
  if (!further.why.empty()) next.why = further.why;
  for (const auto& group : q.rivals)
    if (const auto test = bench_test_for(group.names, q.problem.candidates, q.problem.context.plant)) {
      next.purpose = "split";
      next.kind = test->kind;
      next.order = test->order;
      next.why = test->why + " " + next.why;
      break;
    }
  NextTrial with_parts;
  propose_within(reach.with_any_part(), q, compared, with_parts);
  if (with_parts.is_recommended())
    next.why += fmt::format(
        " With a part that this campaign has neither recorded nor lists under [available] a trial would: "
        "{}: {}",
        with_parts.order, with_parts.why);
}

}  // namespace

void propose_next_trial(Problem& problem, const Recordings& recordings, Search& search,
                        const Posterior& belief, const FreeGain* rest, Diagnosis& diagnosis) {
  NextTrial& next = diagnosis.next;
  const Reach reach(recordings.trials, recordings.available, recordings.words);
  if (diagnosis.detail == Detail::data_fault) {
    record_again(recordings, diagnosis, next);
  } else {
    const auto rivals = rivals_of(problem, search, belief);
    const Question question{problem, recordings, search, belief, rivals, rest, diagnosis};
    Setups compared;
    propose_within(reach, question, compared, next);
    if (!next.is_recommended() && !rivals.empty()) look_further(reach, question, compared, next);
  }
  complete(reach, next);
}

}  // namespace sandhopper::diagnose
