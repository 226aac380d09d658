#include "tools/diagnose/rounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "tools/diagnose/answer/report_parts.hpp"
#include "tools/diagnose/evidence/search_parts.hpp"
#include "tools/diagnose/evidence/simple_answers.hpp"
#include "tools/diagnose/fit/fit.hpp"
#include "tools/diagnose/fit/spread_seen.hpp"
#include "tools/diagnose/model/digits.hpp"
#include "tools/diagnose/model/quantity.hpp"
#include "tools/diagnose/recordings/events.hpp"
#include "tools/diagnose/recordings/many_trials.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr std::size_t kSeeds = 14;  // fits of one round from which the next round starts
// A costly plant with more trials than the first number is searched first with as many as the second.
constexpr std::size_t kManyTrialsInAll = 30, kSearchedTrials = 20;
// With more rows in all trials fewer sets are fitted. An axis campaign of a dozen trials has about as many.
constexpr double kManyRows = 20'000.0;
constexpr std::size_t kSetsTold = 20;
constexpr std::size_t kMostEffects = 6;  // of a cheap plant whose best set leaves more than the noise
constexpr std::size_t kScreenedTold = 15;
constexpr std::size_t kShiftsListed = 4;
constexpr FitOptions kFirst{.max_iterations = 6};  // The noise is only a guess at this stage.
constexpr FitOptions kHere{.columns_made_here = true};
constexpr double kSameNoise = 0.03;  // Largest noise_change() after which the search is not repeated.
// Ratio of the fitted noise to the sensors' own noise above which the noise hides most effects.
constexpr double kNoiseHidesAll = 4.0;

// "suction 0.631 N, onset power 1.5"
std::string values_text(const Candidate& candidate, const std::vector<double>& values) {
  std::string text;
  for (std::size_t i = 0; i < values.size() && i < candidate.parameters.size(); ++i) {
    const auto quantity = quantity_of(candidate.parameters[i].name);
    text += fmt::format("{}{} {}{}{}", text.empty() ? "" : ", ", quantity.words, plain_number(values[i], 3),
                        quantity.unit.empty() ? "" : " ", quantity.unit);
  }
  return text;
}

void log_sets(const Problem& problem, Search& search, Diagnosis& diagnosis) {
  // The screen at the null, and beside the best set with each of its effects left out.
  std::vector<std::vector<std::size_t>> screens{{}};
  for (const auto candidate : search.best().set)
    if (auto part = without(search.best().set, candidate); !part.empty() && search.sets().contains(part))
      screens.push_back(std::move(part));
  for (const auto& set : screens) {
    const auto& screened = search.screened(set);
    for (std::size_t i = 0; i < screened.size() && i < kScreenedTold; ++i)
      diagnosis.log.push_back(
          fmt::format("beside {}: {} would gain {:.1f} (linear) with {}", set_text(problem, set),
                      problem.candidates[screened[i].candidate].label(), screened[i].gain,
                      values_text(problem.candidates[screened[i].candidate], screened[i].values)));
  }
  for (std::size_t i = 0; i < problem.tolerances.size(); ++i)
    diagnosis.log.push_back(
        fmt::format("{}: moved by {:.2f} times its tolerance as believed, by {:.2f} with the best set",
                    problem.tolerances[i].name, search.null().fit.point.tolerances[i],
                    search.best().fit.point.tolerances[i]));
  for (const auto* fit : {&search.null(), &search.best()}) {
    const auto shifts = common_shifts(problem, fit->fit.point);
    for (std::size_t i = 0; i < shifts.size() && i < kShiftsListed; ++i)
      diagnosis.log.push_back(fmt::format("beside {}: all trials need {} alike, by {:.1f} standard errors",
                                          set_text(problem, fit->set), shifts[i].nuisance, shifts[i].z));
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
      evidence += fmt::format("; {}", values_text(problem.candidates[h.candidates[e]], h.values[e]));
    for (const auto& e : f.evidence)
      evidence += fmt::format("; {}: {:.3g} times typical, p {:.1e}, by sign flips {:.3f}, gain {:.1f}{}",
                              problem.candidates[e.candidate].label(), e.typicals, e.p_value, e.flip_p_value,
                              e.gain, e.at_bound ? ", at bound" : "");
    diagnosis.log.push_back(
        fmt::format("set {}: criterion {:.1f}, deviance {:.1f}, dispersion {:.2f}, {}{}{}{}",
                    set_text(problem, f.set), search.criterion(f), f.fit.deviance, f.dispersion,
                    f.needed ? "needed" : "not needed", f.rough ? ", fitted roughly" : "",
                    f.fit.status == FitStatus::failed ? ", fit not settled" : "", evidence));
  }
}

// True if the best set leaves so much that something unknown would be reported beside it.
bool leaves_more_than_noise(const Problem& problem, const Search& search) {
  return misfit_of(problem, search).large ||
         left_over_noise(problem, search.null().fit, search.best().fit).is_more_than_noise() ||
         noisiest_channel(problem);
}

bool has_many_trials(const Problem& problem) { return problem.trials.size() > kManyTrialsInAll; }

struct Settled {
  Point null;
  std::vector<Point> starts;  // Further start points for the search.
};

// Usual share of the work that is done at the start of each step.
constexpr double kOfNull = 0.02, kOfNoise = 0.06, kOfSearch = 0.1, kOfSecondSearch = 0.5;

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

// Estimates the noise at the best set and searches again from the best points. Returns no value if `before`
// is still valid: the noise has not changed, or the limit of time ended the new search.
std::optional<Search> searched_again(Problem& problem, Search& before, const SearchOptions& search_options,
                                     const EngineOptions& options, Diagnosis& diagnosis) {
  const NoiseModel noise = problem.noise;
  const auto used = problem.used;
  const auto errors = problem.model_error;
  update_noise(problem, before.best().fit.point);
  const double change = noise_change(noise, problem.noise);
  diagnosis.log.push_back(
      fmt::format("noise beside the best set {:.2f} times the sensors' own, a share of {:.3f} changed",
                  noise_over_sensors(problem), change));
  const auto back = [&] {
    problem.used = used;
    problem.noise = noise;
    take_model_error(problem, errors);
  };
  if (change < kSameNoise) {
    back();
    return {};
  }
  keep_columns(problem, before.null().fit.point);
  Search again(problem, search_options);
  again.stop_when(options.stop);
  again.run(before.null().fit.point, before.best_points(kSeeds));
  if (again.stopped()) {
    back();
    keep_columns(problem, before.null().fit.point);
    before.set_stopped();
    return {};
  }
  diagnosis.log.emplace_back("searched again with the noise beside the best set");
  log_sets(problem, again, diagnosis);
  return again;
}

// Progress of one round, mapped to the part of the whole from `from` to `to`.
std::function<void(double, const char*)> progress_between(const EngineOptions& options, double from,
                                                          double to) {
  return [&options, from, to](double share, const char* step) {
    options.progress(from + (to - from) * share, step);
  };
}

SearchOptions options_of_first_round(const Problem& problem, const EngineOptions& options,
                                     BalanceLaw& balance) {
  SearchOptions out;
  out.most_effects = options.most_effects;
  out.straight = problem.plant->starts_as_believed();
  // If the simulation is fast, fit more candidates of each screen, and proposals.
  if (!problem.plant->is_costly()) out.fits_per_screen = out.proposals = problem.rows() < kManyRows ? 10 : 6;
  out.costly = problem.plant->is_costly();
  out.progress = progress_between(options, kOfSearch, kOfSecondSearch);
  // If the noise hides most effects and the force balances already show a law, fit only the best candidates
  // of each screen.
  if (noise_over_sensors(problem) > kNoiseHidesAll && balance()) {
    out.straight = false;
    out.fits_of_singles = out.fits_per_screen;
  }
  return out;
}

// In a large campaign of a costly plant a subset of the trials is searched first, and the full
// problem starts from its best points.
Search best_of_rounds(Problem& problem, const Recordings& clean, const Settled& settled,
                      const EngineOptions& options, BalanceLaw& balance, Diagnosis& diagnosis) {
  const bool costly = problem.plant->is_costly();
  const bool subset_first = costly && has_many_trials(problem);
  const bool singles_first = costly && !subset_first;
  SearchOptions search_options = options_of_first_round(problem, options, balance);
  diagnosis.log.push_back(fmt::format("noise {:.2f} times the sensors' own", noise_over_sensors(problem)));
  std::vector<Point> seeds = settled.starts;
  if (subset_first) {
    seeds = seeds_of_some(problem, clean, settled.null, search_options, options);
    search_options.most_effects = search_options.fits_per_screen = search_options.fits_of_singles = 0;
    search_options.straight = false;
  }
  if (singles_first) search_options.most_effects = std::min<std::size_t>(1, options.most_effects);
  Search search(problem, search_options);
  search.stop_when(options.stop);
  search.run(settled.null, seeds);
  if (singles_first && search.best().set.empty()) search.widen(options.most_effects);
  log_sets(problem, search, diagnosis);
  // If the listed effects leave far more than the noise and the force balances show a law, a second search
  // would not help.
  if (search.best().set.empty()) return search;
  options.first_verdict(set_text(problem, search.best().set));
  if (search.stopped() || (misfit_of(problem, search).noticeable && balance())) return search;

  search_options.progress = progress_between(options, kOfSecondSearch, kOfRest);
  // The best points of the search so far only need another fit.
  search_options.most_effects = options.most_effects;
  search_options.fits_of_singles = 3;
  search_options.free_null = !costly;
  search_options.straight = false;
  if (!singles_first) search_options.fits_per_screen = 3;
  auto second = searched_again(problem, search, search_options, options, diagnosis);
  if (!second && singles_first && !search.stopped()) search.widen(options.most_effects);
  Search& best = second ? *second : search;
  // A belief may lack more: for example two frictions, a correct inertia and the encoder's zero at once.
  for (std::size_t most = options.most_effects; !costly && !best.stopped() && most < kMostEffects; ++most)
    if (best.best().set.size() == most &&
        (misfit_of(problem, best).noticeable || leaves_more_than_noise(problem, best)))
      best.widen(most + 1);
  if (!singles_first || best.best().set.size() < 2 || best.stopped()) return best;
  search_options.fits_per_screen = 3;
  auto third = searched_again(problem, best, search_options, options, diagnosis);
  return third ? *third : best;
}

// All rounds. The screens of a cheap plant fit enough effects each; for a costly one all are fitted at the
// end.
Search searched(Problem& problem, const Recordings& clean, const Settled& settled,
                const EngineOptions& options, BalanceLaw& balance, Diagnosis& diagnosis) {
  Search search = best_of_rounds(problem, clean, settled, options, balance, diagnosis);
  if (problem.plant->is_costly() && !has_many_trials(problem)) search.fit_every_other();
  return search;
}

}  // namespace

Search search_in_rounds(Prepared& prepared, Recordings& clean, const EngineOptions& options,
                        BalanceLaw& balance, Diagnosis& diagnosis) {
  Problem& problem = prepared.problem;
  // `known`: sets that the search over longer stretches found, to be fitted first.
  const auto search_from_start = [&](const std::vector<Point>& known) {
    Settled settled = settled_null(problem, options);
    for (Point point : known) {
      point.nuisances = settled.null.nuisances;
      point.tolerances = settled.null.tolerances;
      settled.starts.push_back(std::move(point));
    }
    diagnosis.simple = simple_answers(problem, settled.null);
    return searched(problem, clean, settled, options, balance, diagnosis);
  };
  const auto prepare_again = [&](std::size_t stretch) {
    const auto simulations = problem.simulations;
    prepared = prepare(clean, stretch);
    problem.simulations += simulations;
    balance = BalanceLaw(problem, clean);
  };
  const auto stretches = problem.plant->stretches(clean.trials);
  std::size_t stretch = 0;
  std::string over_long_stretches;  // what the search named before the stretches became shorter
  Search search = search_from_start({});
  while (stretch + 1 < stretches.size() && !search.stopped() && leaves_more_than_noise(problem, search)) {
    if (over_long_stretches.empty() && !search.best().set.empty())
      over_long_stretches = set_text(problem, search.best().set);
    const auto known = search.best_points(kSeeds);
    prepare_again(++stretch);
    diagnosis.log.push_back(
        fmt::format("searched again in shorter stretches: {} times the shortest", stretches[stretch]));
    search = search_from_start(known);
  }
  if (search.best().set.empty() && !over_long_stretches.empty())
    diagnosis.notes.push_back(fmt::format(
        "errors add up over long stretches of the motion: there {} explains a part, and the rest is more "
        "than "
        "the noise, so it is not named; shorter stretches show nothing. Something weak is missing",
        over_long_stretches));
  if (search.stopped()) return search;
  const auto events = find_events(problem, search.best().fit.point);
  if (events.empty()) return search;
  report_events(problem, events, diagnosis);
  diagnosis.log.emplace_back("searched again without what happened once");
  leave_out(events, problem, clean);
  prepare_again(stretch);
  return search_from_start({});
}

}  // namespace sandhopper::diagnose
