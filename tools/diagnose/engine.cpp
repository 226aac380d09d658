#include "tools/diagnose/engine.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>

#include "tools/diagnose/answer/corrected_model.hpp"
#include "tools/diagnose/answer/masses.hpp"
#include "tools/diagnose/answer/report_parts.hpp"
#include "tools/diagnose/discrepancy/unexplained.hpp"
#include "tools/diagnose/evidence/beside.hpp"
#include "tools/diagnose/evidence/calibration.hpp"
#include "tools/diagnose/evidence/posterior.hpp"
#include "tools/diagnose/evidence/search.hpp"
#include "tools/diagnose/evidence/search_parts.hpp"
#include "tools/diagnose/fit/fit.hpp"
#include "tools/diagnose/next/next_trial.hpp"
#include "tools/diagnose/recordings/contradicted_ranges.hpp"
#include "tools/diagnose/recordings/data_faults.hpp"
#include "tools/diagnose/rounds.hpp"

namespace sandhopper::diagnose {
namespace {

// Usual share of the work that is done at the start of each step.
constexpr double kOfErrors = 0.9, kOfBounds = 0.93, kOfNextTrial = 0.97;

// Reports what the best set does not explain.
void report_what_is_left(const Problem& problem, const Unexplained& rest, Diagnosis& diagnosis) {
  if (rest.law) report_unknown(*rest.law, rest.share, diagnosis);
  if (!rest.unknown) return;
  if (!rest.law) report_unknown_near(rest.gap_closed, diagnosis);
  if (diagnosis.effects.empty() && rest.noisy) report_unknown_noise(*rest.noisy, diagnosis);
  if (diagnosis.effects.empty()) report_unknown_shift(rest.shift, diagnosis);
  if (std::ranges::none_of(diagnosis.effects, &FoundEffect::is_unknown))
    report_unknown_of_plant(problem, diagnosis);
}

// Sets the verdict and its effects. Effects that close most of the gap are reported even if something is
// left. The mass of each is multiplied by the fraction of the gap that they close together.
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
  const bool by_names = limit_by_rest(diagnosis.effects, {.gap_closed = rest.gap_closed,
                                                          .unknown = rest.unknown,
                                                          .has_law = rest.law.has_value(),
                                                          .not_checked = too_few || search.stopped()});
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
  for (const auto& spikes : take_spikes(faults))
    diagnosis.notes.push_back(fmt::format(
        "{}: jumps away and back within one or two samples, {} times in {} of {} trials, by up to "
        "{:.3g}; left out",
        spikes.channel, spikes.stretches, spikes.trials.size(), clean.trials.size(), spikes.limit));
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

Unexplained what_is_left(Problem& problem, Search& search, const Belief& belief, bool faults,
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
  report_noise(problem, diagnosis);
  report_trial_to_trial(problem, search, clean.trials, diagnosis);
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

// The answer after a limit of time that ended the search before an effect was found needed. Its residuals are
// those of the belief.
void report_too_little_time(const Problem& problem, const Search& search,
                            const std::vector<DataFault>& faults, Diagnosis& diagnosis) {
  diagnosis.verdict = Verdict::insufficient_time;
  report_residuals(problem, residuals_of_belief(problem, search.null().fit.point), diagnosis);
  report_data_faults(faults, diagnosis);
}

}  // namespace

Diagnosis diagnose(const Recordings& recordings, const EngineOptions& asked) {
  const auto start = std::chrono::steady_clock::now();
  Diagnosis diagnosis;
  const char* step = "";
  EngineOptions options = asked;
  double furthest = 0.0;  // The reported progress does not go back when a search is repeated.
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
  for (auto& note : drop_contradicted_ranges(clean)) diagnosis.notes.push_back(std::move(note));
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
  Search search = search_in_rounds(prepared, clean, options, balance, diagnosis);
  if (search.stopped())
    diagnosis.stopped_in = step;
  else
    name_likeliest(problem, search, diagnosis.log);
  drop_names_in_vain(problem, search, diagnosis);
  if (search.stopped() && search.best().set.empty()) {
    report_too_little_time(problem, search, faults, diagnosis);
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
  Posterior belief = posterior(problem, search, rest.remainder());
  if (!search.stopped()) limit_by_evidence(problem, search, belief, diagnosis.log);
  if (options.tell_evidence) tell_evidence(problem, search, diagnosis.log);
  report_verdict(problem, search, belief, rest, diagnosis);
  for (auto& effect : diagnosis.effects)
    effect.probability = effect.is_unknown() ? effect.mass : calibrated(effect.mass);
  report_broken_rules(problem.plant->broken_rules(clean.trials, clean.beliefs), diagnosis);
  report_data_faults(faults, diagnosis);
  report_around(problem, recordings, clean, belief, rest, answer, search, options, diagnosis);
  return finished(problem);
}

}  // namespace sandhopper::diagnose
