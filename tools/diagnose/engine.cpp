#include "tools/diagnose/engine.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "tools/diagnose/corrected_model.hpp"
#include "tools/diagnose/data_faults.hpp"
#include "tools/diagnose/events.hpp"
#include "tools/diagnose/evidence/posterior.hpp"
#include "tools/diagnose/fit.hpp"
#include "tools/diagnose/left_over.hpp"
#include "tools/diagnose/linearise.hpp"
#include "tools/diagnose/many_trials.hpp"
#include "tools/diagnose/next_trial.hpp"
#include "tools/diagnose/report_parts.hpp"
#include "tools/diagnose/search.hpp"
#include "tools/diagnose/search_parts.hpp"
#include "tools/diagnose/spread_seen.hpp"
#include "tools/diagnose/misfit.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr std::size_t kSeeds = 6;
constexpr std::size_t kManyTrialsInAll = 30, kSearchedTrials = 20;
constexpr double kManyRows = 20'000.0;  // of all trials: what an axis of a dozen trials has
constexpr std::size_t kSetsTold = 20;
constexpr std::size_t kScreenedTold = 15;
constexpr std::size_t kLeansTold = 4;
constexpr std::size_t kLawsFitted = 4;
constexpr FitOptions kFirst{.max_iterations = 6};  // with a noise that is only guessed
constexpr FitOptions kHere{.columns_made_here = true};
constexpr double kSameNoise = 0.03;
constexpr int kNoiseRounds = 3;

void log_sets(const Problem& problem, Search& search, Diagnosis& diagnosis) {
  const auto& screened = search.screened({});
  for (std::size_t i = 0; i < screened.size() && i < kScreenedTold; ++i)
    diagnosis.log.push_back(fmt::format("screen {}: linear gain {:.1f} at [{:.4g}]",
                                        problem.candidates[screened[i].candidate].label(), screened[i].gain,
                                        fmt::join(screened[i].values, ", ")));
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
    std::string values;
    for (const auto& v : f.fit.point.hypothesis.values) values += fmt::format(" [{:.4g}]", fmt::join(v, ", "));
    diagnosis.log.push_back(fmt::format(
        "{} {}{}{}{} deviance {:.1f}, with form {:.1f}, errors x[{}], form x[{} | {}]{}",
        f.judged ? fmt::format("ln mass {:.1f} ({:+.1f} with {} {})", f.log_mass, f.unknown_log_mass - f.log_mass, problem.repeatable_error.groups.empty() ? "" : problem.repeatable_error.groups[f.evidence.unknown].port, problem.repeatable_error.groups.empty() ? "" : problem.repeatable_error.groups[f.evidence.unknown].variable) : fmt::format("about {:.1f}", -0.5 * search.criterion(f)),
        f.rough ? "~" : "", f.fit.status == FitStatus::failed ? "unsettled " : "",
        search.trials_agree(f) ? "" : "trials disagree ", set_text(problem, f.set), f.fit.deviance, f.evidence.deviance, fmt::join(f.evidence.scales.repeatable, " "), fmt::join(f.evidence.scales.form, " "), fmt::join(f.evidence.scales.of_trial, " "), values));
  }
}

void log_noise(const Problem& problem, Diagnosis& diagnosis) {
  for (std::size_t c = 0; c < problem.channels.size(); ++c)
    diagnosis.log.push_back(fmt::format("{}: noise {:.3g}, correlation times {:.1f} samples", problem.channels[c], problem.noise.channel(c).sd(), fmt::join(problem.noise.channel(c).correlation_time, " ")));
}

void log_masses(const Problem& problem, const Search& search, const Posterior& belief,
                const std::vector<LawBeside>& beside, Diagnosis& diagnosis) {
  for (const auto& [candidate, probability] : belief.probability)
    diagnosis.log.push_back(fmt::format("{}: probability {:.3f}", problem.candidates[candidate].label(), probability));
  for (const auto& one : beside)
    diagnosis.log.push_back(fmt::format("unknown at {} of {} beside {}: ln mass {:.1f}, deviance {:.1f}, linearly ln factor {:.1f}, held-out gain {:.1f}, p {:.2g}",
                                        one.law.family.port, one.law.family.variable, set_text(problem, one.set), one.log_mass, one.fit.deviance,
                                        one.law.log_factor, one.law.held_out, one.law.p_value));
  const double explained = search.null().fit.deviance - search.best().fit.deviance;
  diagnosis.log.push_back(fmt::format("unknown: probability {:.3f}, {} the names, {:.1f} % of what can be explained; "
                                      "explained {:.1f}, {:.1f} left of {} rows",
                                      belief.unknown, belief.alone ? "instead of" : "beside", 100.0 * belief.share,
                                      explained, search.best().fit.deviance, problem.rows()));
}

struct Settled {
  Point null;
  std::vector<Point> starts;  // of a search, beside it
  Signatures signatures;      // there
};

// Nothing missing, with a noise that was estimated there.
Settled settled_null(Problem& problem) {
  Point null = fit_from(problem, null_point(problem), kFirst).point;
  update_noise(problem, null);
  keep_columns(problem, null);
  null = fit_from(problem, null, kHere).point;
  auto starts = take_spread_as_seen(problem, null);
  if (!starts.empty()) null = fit_from(problem, null).point;
  Signatures signatures = signatures_at(problem, null);
  for (int round = 0; round < kNoiseRounds; ++round) {
    const NoiseModel before = problem.noise;
    update_noise(problem, null, signatures, round > 0);
    keep_columns(problem, null);
    if (noise_change(before, problem.noise) < kSameNoise) break;
    null = fit_from(problem, null, kHere).point;
  }
  problem.repeatable_error = repeatable_error(problem, null, signatures);
  return {std::move(null), std::move(starts), std::move(signatures)};
}

// All that is searched: once, and again with the noise as it shows with what was found in place. Of many
// trials whose simulation takes long some are searched; what comes near there is where all of them begin.
Search searched(Problem& problem, const Recordings& clean, const Settled& settled,
                const EngineOptions& options, Diagnosis& diagnosis) {
  const Point& null = settled.null;
  SearchOptions search_options;
  search_options.most_effects = options.most_effects;
  search_options.straight = problem.plant->starts_as_believed();
  // Where a simulation takes little, every candidate is tried, not only what the screen puts first.
  if (!problem.plant->is_costly())
    search_options.fits_per_screen = search_options.proposals = problem.rows() < kManyRows ? 10 : 6;
  search_options.progress = [&](double share, const char*) { options.progress(0.45 * share, ""); };
  log_noise(problem, diagnosis);
  std::vector<Point> seeds = settled.starts;
  if (problem.plant->is_costly() && problem.trials.size() > kManyTrialsInAll) {
    Prepared some = prepare(spread_over(clean, kSearchedTrials));
    const Settled of_some = settled_null(some.problem);
    SearchOptions of_some_options = search_options;
    of_some_options.of_null = &of_some.signatures;
    Search search(some.problem, of_some_options);
    search.run(of_some.null, of_some.starts);
    seeds = carried_over(some.problem, search.best_points(kSeeds), problem, null);
    problem.simulations += some.problem.simulations;
    search_options.most_effects = search_options.fits_per_screen = search_options.fits_of_singles = 0;
    search_options.straight = false;
  }
  search_options.of_null = &settled.signatures;
  Search search(problem, search_options);
  search.run(null, seeds);
  log_sets(problem, search, diagnosis);
  if (search.best().set.empty()) return search;

  options.progress(0.45, "first verdict: " + set_text(problem, search.best().set));
  const Point found = search.best().fit.point;
  const Signatures signatures = signatures_at(problem, found);
  update_noise(problem, found, signatures, false, true);
  log_noise(problem, diagnosis);
  whiten_kept_columns(problem);
  problem.repeatable_error = repeatable_error(problem, found, signatures);
  search_options.progress = [&](double share, const char*) { options.progress(0.45 + 0.45 * share, ""); };
  search_options.most_effects = options.most_effects;
  Search second(problem, search_options);
  second.revise(search.null().fit.point, search.best_points(kSeeds), signatures);
  diagnosis.log.emplace_back("second round");
  log_sets(problem, second, diagnosis);
  return second;
}

// By the best set, of what any hypothesis explains: of the sum of squares, in standard deviations of the sensors.
double gap_closed(const Problem& problem, const Search& search, const std::vector<LawBeside>& beside) {
  const double before = deviance_of(problem, search.null().fit.point, problem.channels),
               after = deviance_of(problem, search.best().fit.point, problem.channels);
  double least = after;
  for (const auto& law : beside) least = std::min(least, deviance_of(problem, law.fit.point, problem.channels));
  return before > least ? std::clamp((before - after) / (before - least), 0.0, 1.0) : 1.0;
}

// The verdict and the effects that go with it. Names that close most of the gap are told as such, whatever is left,
// unless they are far less likely than a law that is on no list.
void report_verdict(const Problem& problem, const Search& search, const Posterior& belief,
                    Diagnosis& diagnosis) {
  const bool nothing = search.best().set.empty();
  const bool unknown = belief.unknown > kLimits.named;
  if (nothing && !unknown) {
    const bool too_few = problem.trials.size() < kTooFewTrials;
    diagnosis.verdict = too_few ? "insufficient_data" : "consistent";
    diagnosis.detail = too_few ? "too_little_data" : "null";
    return;
  }
  const bool by_names = !nothing && (!unknown || belief.gap_closed > kLimits.most_of_gap);
  diagnosis.gap_closed = belief.gap_closed;
  if (!nothing) report_effects(problem, search, belief, diagnosis);
  if (unknown)
    for (auto& effect : diagnosis.effects)
      effect.probability = std::min(effect.probability * belief.gap_closed, by_names ? kLimits.beside_unknown : 1.0);
  const bool classes = std::ranges::any_of(
      diagnosis.effects, [](const auto& effect) { return !effect.indistinguishable_from.empty(); });
  if (unknown) {
    const auto& family = belief.law->law.family;
    const double port = belief.unknown_port.at(port_of(family.port, family.sensor));
    report_unknown(belief.law->law, by_names ? std::min(port, kLimits.most_of_gap) : port, 1.0 - belief.gap_closed, diagnosis);
  }
  diagnosis.verdict = by_names ? "missing_physics" : "unknown_physics";
  diagnosis.detail = !by_names ? "unknown_at_port" : unknown ? "known_and_rest" : classes ? "one_of_class" : "known";
}

}  // namespace

Diagnosis diagnose(const Recordings& recordings, const EngineOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  Diagnosis diagnosis;
  Recordings clean = recordings;
  auto faults = remove_data_faults(clean.trials);
  for (const auto& limit : take_known_limits(faults, clean.belief))
    diagnosis.notes.push_back(fmt::format("{}: {} stretches at the end of its range, {:.4g}; left out",
                                          limit.channel, limit.stretches, limit.limit));
  for (const auto& event : take_single_events(faults, clean.trials.size()))
    diagnosis.notes.push_back(fmt::format("{}: {} once, for {:.3g} s; left out", event.channel,
                                          event.id == "data.stuck" ? "stood still" : "fell out",
                                          event.duration_s));
  Prepared prepared = prepare(clean);
  Problem& problem = prepared.problem;
  diagnosis.trials = problem.trials.size();
  note_what_is_missing(prepared, diagnosis);
  if (problem.trials.empty()) {
    diagnosis.verdict = "insufficient_data";
    diagnosis.detail = "too_little_data";
    report_data_faults(faults, diagnosis);
    return diagnosis;
  }
  options.progress(0.0, "");
  Settled settled = settled_null(problem);
  diagnosis.simple = simple_answers(problem, settled.null);
  diagnosis.log.push_back(fmt::format("settled: {} simulations, {:.1f} s", problem.simulations,
                                        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()));
  Search search = searched(problem, clean, settled, options, diagnosis);
  if (const auto events = find_events(problem, search.best().fit.point); !events.empty()) {
    report_events(problem, events, diagnosis);
    diagnosis.log.emplace_back("without what happened once");
    leave_out(events, problem, clean);
    const auto simulations = problem.simulations;
    prepared = prepare(clean);
    problem.simulations += simulations;
    settled = settled_null(problem);
    diagnosis.simple = simple_answers(problem, settled.null);
    search = searched(problem, clean, settled, options, diagnosis);
  }
  if (!search.best().set.empty()) keep_columns(problem, search.best().fit.point);
  options.progress(0.9, "");
  const auto told = [&](const char* what) {
    diagnosis.log.push_back(fmt::format("{}: {} simulations, {:.1f} s", what, problem.simulations,
                                        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()));
  };
  told("searched");
  std::vector<LawBeside> beside;
  std::vector<std::vector<std::size_t>> bases{{}};
  if (!search.best().set.empty()) bases.push_back(search.best().set);
  if (const auto single = search.likeliest_of_size(1); single && *single != search.best().set) bases.push_back(*single);
  for (const auto& set : bases) {
    const SetFit& base = search.sets().at(set);
    auto laws = unknown_laws(problem, base.fit.point, base.evidence.scales,
                             signatures_at(problem, base.fit.point, {.effects = false}));
    // What was weighed alone is weighed beside names, too.
    std::ranges::stable_partition(laws, [&](const UnknownLaw& law) {
      return std::ranges::any_of(beside, [&](const LawBeside& other) {
        return other.set.empty() && is_same_law(other.law, law);
      });
    });
    for (auto& law : weighed_laws(problem, set, base.fit, laws, set.empty() ? kLawsFitted : 2 * kLawsFitted))
      beside.push_back(std::move(law));
  }
  Posterior belief = posterior(problem, search, beside);
  search.take(belief.best);
  belief.gap_closed = gap_closed(problem, search, beside);
  log_masses(problem, search, belief, beside, diagnosis);
  told("weighed");
  report_verdict(problem, search, belief, diagnosis);
  Point answer = search.best().fit.point;
  if (!diagnosis.unknown.empty()) answer = belief.law->fit.point;
  report_broken_rules(problem.plant->broken_rules(clean.trials, clean.beliefs), diagnosis);
  report_data_faults(faults, diagnosis);
  const UnknownLaw* law = diagnosis.unknown.empty() ? nullptr : &belief.law->law;
  const Residuals residuals = residuals_of(problem, search.null().fit.point, answer);
  report_errors(problem, residuals, diagnosis);
  report_trial_to_trial(problem, search, diagnosis);
  report_residuals(problem, residuals, diagnosis);
  report_absent(problem, search, diagnosis);
  report_where(problem, search, residuals, diagnosis);
  report_traces(problem, clean, residuals, diagnosis);
  told("reported");
  propose_next_trial(problem, clean, search, belief, law, diagnosis);
  if (!diagnosis.effects.empty())
    diagnosis.corrected_model_toml = corrected_model(recordings, problem, diagnosis);
  diagnosis.simulations = problem.simulations;
  diagnosis.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  options.progress(1.0, "");
  return diagnosis;
}

}  // namespace sandhopper::diagnose
