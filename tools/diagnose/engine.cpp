#include "tools/diagnose/engine.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>

#include "tools/diagnose/answer/corrected_model.hpp"
#include "tools/diagnose/answer/report_parts.hpp"
#include "tools/diagnose/discrepancy/unexplained.hpp"
#include "tools/diagnose/evidence/beside.hpp"
#include "tools/diagnose/evidence/posterior.hpp"
#include "tools/diagnose/evidence/search.hpp"
#include "tools/diagnose/evidence/search_parts.hpp"
#include "tools/diagnose/fit/fit.hpp"
#include "tools/diagnose/fit/spread_seen.hpp"
#include "tools/diagnose/next/next_trial.hpp"
#include "tools/diagnose/recordings/data_faults.hpp"
#include "tools/diagnose/recordings/events.hpp"
#include "tools/diagnose/recordings/many_trials.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr std::size_t kSeeds = 14;
constexpr std::size_t kManyTrialsInAll = 30, kSearchedTrials = 20;
// Rows of all trials; an axis campaign of a dozen trials has about as many.
constexpr double kManyRows = 20'000.0;
constexpr std::size_t kSetsTold = 20;
constexpr std::size_t kScreenedTold = 15;
constexpr std::size_t kLeansTold = 4;
constexpr FitOptions kFirst{.max_iterations = 6};  // The noise is only a guess at this stage.
constexpr FitOptions kHere{.columns_made_here = true};
constexpr double kSameNoise = 0.03;
constexpr double kNoiseHidesAll = 4.0;  // Ratio to the sensors' own noise.
constexpr double kLikelierThanNot = 0.5;
// If the named effects explain less than this fraction of the held-out energy that can be explained, the
// verdict is unknown physics.
constexpr double kMostOfTheGap = 0.5;
// Largest probabilities if names close most of the gap and something is left: the rest may be an error in the
// form of a named law.
constexpr double kNameBesideUnknown = 0.7, kUnknownBesideNames = 0.5;

void log_sets(const Problem& problem, Search& search, Diagnosis& diagnosis) {
  // The screen at the null, and beside the best set with each of its effects left out.
  std::vector<std::vector<std::size_t>> screens{{}};
  for (const auto candidate : search.best().set)
    if (auto part = without(search.best().set, candidate); !part.empty() && search.sets().contains(part))
      screens.push_back(std::move(part));
  for (const auto& set : screens) {
    const auto& screened = search.screened(set);
    for (std::size_t i = 0; i < screened.size() && i < kScreenedTold; ++i)
      diagnosis.log.push_back(fmt::format("screen beside {}: {}: linear gain {:.1f} at [{:.4g}]",
                                          set_text(problem, set),
                                          problem.candidates[screened[i].candidate].label(), screened[i].gain,
                                          fmt::join(screened[i].values, ", ")));
  }
  for (std::size_t i = 0; i < problem.tolerances.size(); ++i)
    diagnosis.log.push_back(fmt::format("{}: {:.2f} times what is unsure, {:.2f} with the best",
                                        problem.tolerances[i].name, search.null().fit.point.tolerances[i],
                                        search.best().fit.point.tolerances[i]));
  for (const auto* fit : {&search.null(), &search.best()}) {
    const auto leans = leans_of(problem, fit->fit.point);
    for (std::size_t i = 0; i < leans.size() && i < kLeansTold; ++i)
      diagnosis.log.push_back(fmt::format("all trials lean alike with {}: {} by {:.1f}",
                                          set_text(problem, fit->set), leans[i].nuisance, leans[i].z));
  }
  std::vector<const SetFit*> fits;
  for (const auto& [set, fit] : search.sets()) fits.push_back(&fit);
  std::sort(fits.begin(), fits.end(),
            [&](const SetFit* a, const SetFit* b) { return search.criterion(*a) < search.criterion(*b); });
  for (std::size_t i = 0; i < fits.size() && i < kSetsTold; ++i) {
    const auto& f = *fits[i];
    std::string evidence;
    const auto& h = f.fit.point.hypothesis;
    for (std::size_t e = 0; e < h.candidates.size(); ++e)
      evidence += fmt::format(" [{:.4g}]", fmt::join(h.values[e], ", "));
    for (const auto& e : f.evidence)
      evidence += fmt::format(" ({}: {:.3g} typical, p {:.1e}, flip {:.3f}, gain {:.1f}{})",
                              problem.candidates[e.candidate].label(), e.typicals, e.p_value, e.flip_p_value,
                              e.gain, e.at_bound ? ", at bound" : "");
    diagnosis.log.push_back(fmt::format("criterion {:.1f} deviance {:.1f} dispersion {:.2f} {}{}{} {}{}",
                                        search.criterion(f), f.fit.deviance, f.dispersion, f.rough ? "~" : "",
                                        f.fit.status == FitStatus::failed ? "unsettled " : "",
                                        f.needed ? "needed" : "-", set_text(problem, f.set), evidence));
  }
}

struct Settled {
  Point null;
  std::vector<Point> starts;  // Further start points for the search.
};

// Share of the work at the start of each step, as a rule.
constexpr double kOfNull = 0.02, kOfNoise = 0.06, kOfSearch = 0.1, kOfSecondSearch = 0.5, kOfRest = 0.85,
                 kOfErrors = 0.9, kOfBounds = 0.93, kOfNextTrial = 0.97;

// Fits the null (nothing missing) and estimates the noise there.
Settled settled_null(Problem& problem, const EngineOptions& options) {
  options.progress(kOfNull, "fitting the belief as it is");
  Point null = fit_from(problem, null_point(problem), kFirst).point;
  if (options.stop()) {
    keep_columns(problem, null);
    return {std::move(null), {}};
  }
  options.progress(kOfNoise, "estimating the noise");
  update_noise(problem, null);
  keep_columns(problem, null);
  null = fit_from(problem, null, kHere).point;
  auto starts = take_spread_as_seen(problem, null);
  if (!starts.empty()) null = fit_from(problem, null).point;
  keep_columns(problem, null);
  return {std::move(null), std::move(starts)};
}

// Start points for a large campaign of a costly plant: search a subset of the trials and return its best
// points.
std::vector<Point> seeds_of_some(Problem& problem, const Recordings& clean, const Point& null,
                                 const SearchOptions& options, const EngineOptions& engine) {
  Prepared some = prepare(spread_over(clean, kSearchedTrials));
  const Settled of_some = settled_null(some.problem, engine);
  Search search(some.problem, options);
  search.stop_when(engine.stop);
  search.run(of_some.null, of_some.starts);
  problem.simulations += some.problem.simulations;
  return carried_over(some.problem, search.best_points(kSeeds), problem, null);
}

// The whole search, repeated with the noise estimated at the first result. In a large campaign of a costly
// plant a subset of the trials is searched first, and the full problem starts from its best points.
Search searched(Problem& problem, const Recordings& clean, const Settled& settled,
                const EngineOptions& options, BalanceLaw& balance, Diagnosis& diagnosis) {
  const Point& null = settled.null;
  SearchOptions search_options;
  search_options.most_effects = options.most_effects;
  search_options.straight = problem.plant->starts_as_believed();
  // Cheap simulation: fit more candidates of each screen, and proposals.
  if (!problem.plant->is_costly())
    search_options.fits_per_screen = search_options.proposals = problem.rows() < kManyRows ? 10 : 6;
  search_options.progress = [&](double share, const char* step) {
    options.progress(kOfSearch + (kOfSecondSearch - kOfSearch) * share, step);
  };
  diagnosis.log.push_back(fmt::format("noise {:.2f} times the sensors' own", noise_over_sensors(problem)));
  // If the residual hides nearly everything else and the force balances already show a law, restrict the
  // search to the nearest candidates.
  if (noise_over_sensors(problem) > kNoiseHidesAll && balance()) {
    search_options.straight = false;
    search_options.fits_of_singles = search_options.fits_per_screen;
  }
  std::vector<Point> seeds = settled.starts;
  if (problem.plant->is_costly() && problem.trials.size() > kManyTrialsInAll) {
    seeds = seeds_of_some(problem, clean, null, search_options, options);
    search_options.most_effects = search_options.fits_per_screen = search_options.fits_of_singles = 0;
    search_options.straight = false;
  }
  Search search(problem, search_options);
  search.stop_when(options.stop);
  search.run(null, seeds);
  log_sets(problem, search, diagnosis);
  // If the listed effects leave far more than the noise and the force balances show a law, a second search
  // would not help.
  if (search.best().set.empty()) return search;
  options.first_verdict(set_text(problem, search.best().set));
  if (search.stopped() || (misfit_of(problem, search).noticeable && balance())) return search;

  const NoiseModel noise = problem.noise;
  const auto used = problem.used;
  const auto errors = problem.model_error;
  update_noise(problem, search.best().fit.point);
  const double change = noise_change(noise, problem.noise);
  diagnosis.log.push_back(fmt::format("noise {:.2f} times the sensors' own, changed by {:.3f}",
                                      noise_over_sensors(problem), change));
  const auto back_to_first = [&] {
    problem.used = used;
    problem.noise = noise;
    take_model_error(problem, errors);
  };
  if (change < kSameNoise) {
    back_to_first();
    return search;
  }
  keep_columns(problem, search.null().fit.point);
  search_options.progress = [&](double share, const char* step) {
    options.progress(kOfSecondSearch + (kOfRest - kOfSecondSearch) * share, step);
  };
  // The best points of the first search only need another fit.
  search_options.most_effects = options.most_effects;
  search_options.fits_per_screen = search_options.fits_of_singles = 3;
  search_options.straight = false;
  Search second(problem, search_options);
  second.stop_when(options.stop);
  second.run(search.null().fit.point, search.best_points(kSeeds));
  if (second.stopped()) {  // The first search was complete: its answer stands.
    back_to_first();
    keep_columns(problem, search.null().fit.point);
    search.set_stopped();
    return search;
  }
  diagnosis.log.emplace_back("second round");
  log_sets(problem, second, diagnosis);
  return second;
}

// Reports what the best set does not explain.
void report_what_is_left(const Problem& problem, const Unexplained& rest, Diagnosis& diagnosis) {
  if (rest.law) report_unknown(*rest.law, rest.share, diagnosis);
  if (!rest.unknown) return;
  if (!rest.law) report_unknown_near(rest.gap_closed, diagnosis);
  if (diagnosis.effects.empty() && rest.loud) report_unknown_loud(*rest.loud, diagnosis);
  if (diagnosis.effects.empty()) report_unknown_leaning(rest.lean, diagnosis);
  if (std::ranges::none_of(diagnosis.effects, &FoundEffect::is_unknown))
    report_unknown_of_plant(problem, diagnosis);
}

// Sets the verdict and its effects. Effects that close most of the gap are reported even if something is
// left. The probability of each is multiplied by the fraction of the gap that they close together.
void report_verdict(const Problem& problem, const Search& search, const Posterior& belief,
                    const Unexplained& rest, Diagnosis& diagnosis) {
  const bool too_few = problem.trials.size() < kTooFewTrials, named = !search.best().set.empty();
  if (!named && !rest.unknown) {
    diagnosis.verdict = too_few ? Verdict::insufficient_data : Verdict::consistent;
    diagnosis.detail = too_few ? Detail::too_little_data : Detail::none;
    return;
  }
  if (named) report_effects(problem, search, belief, diagnosis);
  report_what_is_left(problem, rest, diagnosis);
  diagnosis.gap_closed = rest.gap_closed;
  if (rest.unknown || rest.law)
    for (auto& effect : diagnosis.effects)
      if (!effect.is_unknown()) effect.probability *= rest.gap_closed;
  const bool by_names = rest.gap_closed > kMostOfTheGap &&
                        std::ranges::any_of(diagnosis.effects, [](const FoundEffect& effect) {
                          return !effect.is_unknown() && effect.probability > kLikelierThanNot;
                        });
  if (by_names)
    for (auto& effect : diagnosis.effects) {
      if (effect.is_unknown()) effect.probability = std::min(effect.probability, kUnknownBesideNames);
      if (rest.unknown) effect.probability = std::min(effect.probability, kNameBesideUnknown);
    }
  if (!by_names && rest.unknown) {
    diagnosis.verdict = Verdict::unknown_physics;
    diagnosis.detail = rest.law ? Detail::unknown_at_port : Detail::unknown_not_localised;
    std::ranges::stable_partition(diagnosis.effects, &FoundEffect::is_unknown);
    return;
  }
  const bool classes = std::ranges::any_of(
      diagnosis.effects, [](const auto& effect) { return !effect.indistinguishable_from.empty(); });
  diagnosis.verdict = Verdict::missing_physics;
  diagnosis.detail = rest.unknown || (rest.law && !classes) ? Detail::known_and_rest
                     : classes                              ? Detail::one_of_class
                                                            : Detail::known;
}

// Removes entries from `faults` that are no faults (known range limits, single events) and adds a note for
// each.
void note_what_is_no_fault(std::vector<DataFault>& faults, const Recordings& clean, Diagnosis& diagnosis) {
  for (const auto& limit : take_known_limits(faults, clean.belief))
    diagnosis.notes.push_back(fmt::format("{}: {} stretches at the end of its range, {:.4g}; left out",
                                          limit.channel, limit.stretches, limit.limit));
  for (const auto& event : take_single_events(faults, clean.trials.size()))
    diagnosis.notes.push_back(fmt::format("{}: {} once, for {:.3g} s; left out", event.channel,
                                          event.id == "data.stuck" ? "stood still" : "fell out",
                                          event.duration_s));
}

// Drops the named effects if held-out trials do not come nearer with them. Not for costly plants (hoppers):
// their nuisance parameters vary too much for this test.
void drop_names_in_vain(const Problem& problem, Search& search, Diagnosis& diagnosis) {
  if (problem.plant->is_costly() || search.best().set.empty()) return;
  const Point &null = search.null().fit.point, &point = search.best().fit.point;
  if (held_out_gain(problem, residuals_of(problem, null, point), null, point) > 0.0) return;
  diagnosis.log.push_back("held-out trials are no nearer with " + set_text(problem, search.best().set));
  search.name_nothing();
}

// The search, repeated without what happened once in a recording.
Search searched_without_events(Prepared& prepared, Recordings& clean, const EngineOptions& options,
                               BalanceLaw& balance, Diagnosis& diagnosis) {
  Problem& problem = prepared.problem;
  Settled settled = settled_null(problem, options);
  diagnosis.simple = simple_answers(problem, settled.null);
  Search search = searched(problem, clean, settled, options, balance, diagnosis);
  if (search.stopped()) return search;
  const auto events = find_events(problem, search.best().fit.point);
  if (events.empty()) return search;
  report_events(problem, events, diagnosis);
  diagnosis.log.emplace_back("without what happened once");
  leave_out(events, problem, clean);
  const auto simulations = problem.simulations;
  prepared = prepare(clean);
  problem.simulations += simulations;
  settled = settled_null(problem, options);
  diagnosis.simple = simple_answers(problem, settled.null);
  balance = BalanceLaw(problem, clean);
  return searched(problem, clean, settled, options, balance, diagnosis);
}

Unexplained what_is_left(const Problem& problem, Search& search, const Belief& belief, bool faults,
                         BalanceLaw& balance, Diagnosis& diagnosis) {
  auto rest = unexplained_by(problem, search, belief, faults, balance, diagnosis.log);
  // If a listed effect explains the rest as well as the free law, name it, however small it is.
  if (rest.unknown && rest.law && search.name_small(rest.remainder())) {
    drop_names_in_vain(problem, search, diagnosis);
    rest = unexplained_by(problem, search, belief, faults, balance, diagnosis.log);
  }
  return rest;
}

// Reports everything besides the verdict: errors, places, bounds, next trial, corrected model. After a limit
// of time only what follows from the fits at hand.
void report_around(Problem& problem, const Recordings& recordings, const Recordings& clean,
                   const Posterior& belief, const Unexplained& rest, const Point& answer, Search& search,
                   const EngineOptions& options, Diagnosis& diagnosis) {
  const bool stopped = search.stopped();
  options.progress(kOfErrors, "comparing with held-out trials");
  const Residuals residuals = residuals_of(problem, search.null().fit.point, answer);
  report_errors(problem, residuals, diagnosis);
  report_trial_to_trial(problem, search, diagnosis);
  report_residuals(problem, residuals, diagnosis);
  options.progress(kOfBounds, "bounding absent effects");
  if (!stopped) report_absent(problem, search, diagnosis);
  if (!stopped) report_belief(problem, search.best().fit.point, diagnosis);
  report_where(problem, search, residuals, diagnosis);
  report_traces(problem, clean, residuals, diagnosis);
  options.progress(kOfNextTrial, "choosing the next trial");
  if (!stopped)
    propose_next_trial(problem, clean, search, belief, rest.law ? &*rest.law : nullptr, diagnosis);
  if (!diagnosis.effects.empty())
    diagnosis.corrected_model_toml = corrected_model(recordings, problem, diagnosis);
}

// The answer after a limit of time that ended the search before an effect was found needed.
void report_too_little_time(const std::vector<DataFault>& faults, Diagnosis& diagnosis) {
  diagnosis.verdict = Verdict::insufficient_time;
  report_data_faults(faults, diagnosis);
}

}  // namespace

Diagnosis diagnose(const Recordings& recordings, const EngineOptions& asked) {
  const auto start = std::chrono::steady_clock::now();
  Diagnosis diagnosis;
  const char* step = "";
  EngineOptions options = asked;
  double furthest = 0.0;  // A search that is repeated does not go back.
  options.progress = [&](double share, const char* begun) {
    furthest = std::max(furthest, share);
    asked.progress(furthest, step = begun);
  };
  const auto finished = [&](const Problem& problem) {
    diagnosis.simulations = problem.simulations;
    diagnosis.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    asked.progress(1.0, "");
    return diagnosis;
  };
  options.progress(0.0, "preparing the trials");
  Recordings clean = recordings;
  auto faults = remove_data_faults(clean.trials);
  note_what_is_no_fault(faults, clean, diagnosis);
  Prepared prepared = prepare(clean);
  Problem& problem = prepared.problem;
  diagnosis.trials = problem.trials.size();
  diagnosis.belief = options.belief;
  note_what_is_missing(prepared, diagnosis);
  if (problem.trials.empty()) {
    diagnosis.verdict = Verdict::insufficient_data;
    diagnosis.detail = Detail::too_little_data;
    report_data_faults(faults, diagnosis);
    return diagnosis;
  }
  BalanceLaw balance(problem, clean);
  Search search = searched_without_events(prepared, clean, options, balance, diagnosis);
  if (search.stopped()) diagnosis.stopped_in = step;
  drop_names_in_vain(problem, search, diagnosis);
  if (search.stopped() && search.best().set.empty()) {
    report_too_little_time(faults, diagnosis);
    return finished(problem);
  }
  if (!search.best().set.empty()) keep_columns(problem, search.best().fit.point);
  options.progress(kOfRest, "looking for what no listed effect explains");
  Unexplained rest = search.stopped()
                         ? Unexplained()
                         : what_is_left(problem, search, clean.belief, !faults.empty(), balance, diagnosis);
  Point answer = search.best().fit.point;
  if (rest.law && (rest.unknown || !search.best().set.empty()))
    answer = with_law_fitted(problem, search.best().fit, *rest.law);
  const Posterior belief = posterior(problem, search, rest.remainder());
  if (options.tell_evidence) tell_evidence(problem, search, diagnosis.log);
  report_verdict(problem, search, belief, rest, diagnosis);
  report_broken_rules(problem.plant->broken_rules(clean.trials, clean.beliefs), diagnosis);
  report_data_faults(faults, diagnosis);
  report_around(problem, recordings, clean, belief, rest, answer, search, options, diagnosis);
  return finished(problem);
}

}  // namespace sandhopper::diagnose
