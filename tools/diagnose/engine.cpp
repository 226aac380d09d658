#include "tools/diagnose/engine.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "tools/diagnose/balance.hpp"
#include "tools/diagnose/corrected_model.hpp"
#include "tools/diagnose/data_faults.hpp"
#include "tools/diagnose/fit.hpp"
#include "tools/diagnose/left_over.hpp"
#include "tools/diagnose/misfit.hpp"
#include "tools/diagnose/next_trial.hpp"
#include "tools/diagnose/open_world.hpp"
#include "tools/diagnose/posterior.hpp"
#include "tools/diagnose/report_parts.hpp"
#include "tools/diagnose/search.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr double kUnknownShare = 0.30;  // of what can be explained: more than this the library does not say
constexpr double kUnknownSignificance = 0.003;
constexpr double kSmallestLaw =
    0.1;  // of the port's scale, at its largest: what is smaller matters to nobody
constexpr double kUnknownShareOfDeviance = 0.03;  // a null campaign's own misfits stay below
constexpr double kUnknownPerRow = 0.3;  // so much of the noise's own power left is no matter of form
constexpr double kMisfitSignificance = 0.05;
constexpr double kOutdone = 1.3;
constexpr double kDoubtBesideUnknown = 0.3;  // none of 7 such names was right on seed 5600
constexpr std::size_t kSeeds = 14;
constexpr std::size_t kSetsTold = 20;
constexpr std::size_t kScreenedTold = 15;
constexpr std::size_t kLeansTold = 4;
constexpr FitOptions kFirst{.max_iterations = 6};  // with a noise that is only guessed
constexpr double kUnknownGain = 25.0;
constexpr double kUnknownGainPerRow = 0.004;  // less moves nothing by a noticeable part of the floor
constexpr double kBalanceShare = 0.25;  // of a trial's variance; with nothing missing it stays below 0.05
constexpr double kBalanceSignificance = 0.01;
constexpr double kSameNoise = 0.03;
// Of trials that lean alike, beside names (with the right ones up to 3.3) and without any (nulls up to 2.9).
constexpr double kLeansBeside = 4.5, kLeansAlone = 6.0;
constexpr double kMoreThanNoise = 1.35;  // of it left; nulls of seed 9023 up to 1.00, of 9025 up to 1.13
// Of the noise over the sensors' own with the best set in place: with nothing missing it stays below.
constexpr double kNoiseHidesMuch = 1.3;
constexpr double kNoiseHidesAll = 4.0;

Misfit misfit_of(const Problem& problem, const Search& search) {
  std::vector<TrialMisfit> trials;
  for (std::size_t t = 0; t < problem.trials.size(); ++t)
    trials.push_back(
        {search.best().fit.trial_deviance[t], static_cast<double>(problem.trials[t]->rows.size())});
  auto m = misfit_of(trials, search.null().fit.deviance, problem.plant->motion_is_prescribed());
  if (m.outweighs && !search.best().set.empty()) m.large = m.noticeable = true;  // names that say little
  return m;
}

// A law that the balances of the recordings show by themselves. Not one of the drive's torque: what the list
// says of the actuator looks like that; nor of time, which goes with everything.
std::optional<FreeGain> law_of_balances(const Problem& problem, const Recordings& recordings) {
  std::vector<Balance> balances;
  for (std::size_t i = 0; i < recordings.trials.size(); ++i)
    for (auto& balance : problem.plant->balances(recordings.trials[i], recordings.beliefs[i]))
      balances.push_back(std::move(balance));
  for (auto& gain : laws_of_balances(problem, balances))
    if (gain.family.variable != "torque_Nm" && gain.family.variable != "t_s" &&
        gain.held_out > kBalanceShare && gain.p_value < kBalanceSignificance && gain.trials_better >= 0.75)
      return std::move(gain);
  return std::nullopt;
}

std::string set_text(const Problem& problem, const std::vector<std::size_t>& set) {
  if (set.empty()) return "nothing";
  std::string text;
  for (const auto c : set) text += (text.empty() ? "" : " + ") + problem.candidates[c].label();
  return text;
}

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
            [](const SetFit* a, const SetFit* b) { return a->fit.deviance < b->fit.deviance; });
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
    diagnosis.log.push_back(fmt::format("deviance {:.1f} dispersion {:.2f} {}{} {}{}", f.fit.deviance,
                                        f.dispersion, f.rough ? "~" : "", f.needed ? "needed" : "-",
                                        set_text(problem, f.set), evidence));
  }
}

}  // namespace

Diagnosis diagnose(const Recordings& recordings, const EngineOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  Diagnosis diagnosis;
  Recordings clean = recordings;
  const auto faults = remove_data_faults(clean.trials);
  Prepared prepared = prepare(clean);
  Problem& problem = prepared.problem;
  diagnosis.trials = problem.trials.size();
  note_what_is_missing(prepared, diagnosis);
  if (problem.trials.empty()) {
    diagnosis.verdict = "insufficient_data";
    diagnosis.detail = "too_little_data";
    return diagnosis;
  }
  options.progress(0.0, "");
  Point point = fit_from(problem, null_point(problem), kFirst).point;
  update_noise(problem, point);
  keep_columns(problem, point);
  point = fit_from(problem, point).point;
  keep_columns(problem, point);
  diagnosis.simple = simple_answers(problem, point);
  SearchOptions search_options;
  search_options.most_effects = options.most_effects;
  search_options.straight = problem.plant->starts_as_believed();
  // Where a simulation takes little, every candidate is tried, not only what the screen puts first.
  if (!problem.plant->is_costly()) {
    search_options.fits_per_screen = 10;
    search_options.proposals = 10;
  }
  search_options.progress = [&](double share, const char*) { options.progress(0.45 * share, ""); };
  std::optional<FreeGain> shown;
  bool asked = false;
  const auto what_balances_show = [&]() -> const std::optional<FreeGain>& {
    if (!asked) shown = law_of_balances(problem, clean);  // no fit changes them
    asked = true;
    return shown;
  };
  diagnosis.log.push_back(fmt::format("noise {:.2f} times the sensors' own", noise_over_sensors(problem)));
  // Where next to nothing else is seen and the recordings' balances may say at once what it is, a search
  // looks at what is nearest only.
  if (noise_over_sensors(problem) > kNoiseHidesAll && what_balances_show()) {
    search_options.straight = false;
    search_options.fits_of_singles = search_options.fits_per_screen;
  }
  Search search(problem, search_options);
  search.run(point);
  log_sets(problem, search, diagnosis);
  // Where the list leaves far more than the noise and the balances say what it is, no second look at the list
  // would help.
  std::optional<FreeGain> balance;
  if (misfit_of(problem, search).noticeable) balance = what_balances_show();
  if (!search.best().set.empty() && !balance) {
    // With what was found in place the noise may show better; then everything is weighed again.
    options.progress(0.45, "first verdict: " + set_text(problem, search.best().set));
    const NoiseModel noise = problem.noise;
    const auto used = problem.used;
    update_noise(problem, search.best().fit.point);
    const double change = noise_change(noise, problem.noise);
    diagnosis.log.push_back(fmt::format("noise {:.2f} times the sensors' own, changed by {:.3f}",
                                        noise_over_sensors(problem), change));
    if (change < kSameNoise) {
      problem.noise = noise;
      problem.used = used;
    } else {
      keep_columns(problem, search.best().fit.point);
      const Point again = search.null().fit.point;
      search_options.progress = [&](double share, const char*) { options.progress(0.45 + 0.45 * share, ""); };
      // What came near already needs no search, but another fit.
      const auto seeds = search.best_points(kSeeds);
      search_options.fits_per_screen = search_options.fits_of_singles = 3;
      search_options.straight = false;
      Search second(problem, search_options);
      second.run(again, seeds);
      search = std::move(second);
      diagnosis.log.emplace_back("second round");
      log_sets(problem, search, diagnosis);
    }
  }
  options.progress(0.9, "");
  const SetFit& best = search.best();
  const auto gains = free_gains(problem, best.fit.point);
  const Misfit misfit = misfit_of(problem, search);
  const double explained = misfit.explained, rows = problem.rows();
  const FreeGain* rest = nullptr;
  const double form = problem.plant->form_error();
  const double least_gain =
      std::max({kUnknownGain, kUnknownGainPerRow * rows,
                std::min(kUnknownShareOfDeviance, 10.0 * form) * best.fit.deviance, form * explained});
  for (const auto& gain : gains)
    if (rest == nullptr && problem.trials.size() >= kTooFewTrials && gain.held_out > least_gain &&
        gain.p_value < kUnknownSignificance && gain.trials_better >= 0.75 &&
        gain.size.cwiseAbs().maxCoeff() > kSmallestLaw)
      rest = &gain;
  for (std::size_t i = 0; i < gains.size() && i < 4; ++i)
    diagnosis.log.push_back(fmt::format(
        "free law at {} of {}: held-out gain {:.1f}, p {:.1e}, better in {:.0f} %, largest {:.3g}",
        gains[i].family.port, gains[i].family.variable, gains[i].held_out, gains[i].p_value,
        100.0 * gains[i].trials_better, gains[i].family.scale * gains[i].size.cwiseAbs().maxCoeff()));
  // Where the best set leaves far more than the noise, it is no explanation, and it bends the laws of free
  // form, too: they are asked again without it.
  std::vector<FreeGain> alone;
  if (misfit.noticeable || noise_over_sensors(problem) > kNoiseHidesMuch) balance = what_balances_show();
  if (balance) {
    diagnosis.log.push_back(fmt::format("balance at {}, {}: {:.0f} % of a trial's variance, p {:.1e}",
                                        balance->family.port, balance->family.variable,
                                        100.0 * balance->held_out, balance->p_value));
    balance->held_out = misfit.unexplained;
    rest = &*balance;
  }
  if (misfit.large && rest == nullptr) {
    alone = free_gains(problem, search.null().fit.point);
    for (const auto& gain : alone)
      if (rest == nullptr && gain.held_out > least_gain &&
          (gain.p_value < kMisfitSignificance || problem.plant->motion_is_prescribed()))
        rest = &gain;
  }
  // Where a law of free form says more of trials it has not seen than the best names of those they were
  // fitted to, the names are not it.
  bool outdone = false;
  if (!best.set.empty() && rest == nullptr) {
    if (alone.empty()) alone = free_gains(problem, search.null().fit.point);
    for (const auto& gain : alone)
      if (rest == nullptr && gain.held_out > kOutdone * explained + least_gain &&
          gain.p_value < kMisfitSignificance && gain.trials_better >= 0.75)
        rest = &gain;
    outdone = rest != nullptr;
  }
  const auto share_of = [&](const FreeGain* gain) {
    return gain == nullptr ? 0.0 : gain->held_out / (gain->held_out + std::max(explained, 0.0));
  };
  // Where the sensors are known and more is left than their noise, that is something, whatever it is.
  const double left = left_over_noise(problem, best.fit);
  // The same where it bends what differs from trial to trial by so much in all of them.
  const Lean lean =
      problem.plant->says_how_trials_differ(clean.belief) ? largest_lean(problem, best.fit.point) : Lean{};
  const bool leans = std::abs(lean.z) > (best.set.empty() ? kLeansAlone : kLeansBeside);
  const bool more_than_noise = faults.empty() && (left > kMoreThanNoise || leans);
  diagnosis.log.push_back(
      fmt::format("left: {:.2f} times the noise; all trials lean by {:.1f} {}", left, lean.z, lean.nuisance));
  if (more_than_noise && best.set.empty() && rest == nullptr)
    for (const auto& gain : gains)
      if (rest == nullptr && !gain.family.sensor && gain.held_out > least_gain &&
          (left > kMoreThanNoise || gain.family.port.starts_with(lean.port)))
        rest = &gain;
  // What lies within the noise and is little beside what was found is nothing unknown.
  if (!outdone && !more_than_noise && best.fit.deviance < rows && share_of(rest) <= kUnknownShare)
    rest = nullptr;
  const double remainder = rest ? rest->held_out : 0.0;
  const double share = share_of(rest);
  diagnosis.log.push_back(
      fmt::format("explained {:.1f}, left {:.1f} beyond the noise, rest {:.1f} ({:.1f} %), {} rows",
                  explained, misfit.unexplained, remainder, 100.0 * share, rows));

  const Posterior belief = posterior(problem, search, remainder);
  const bool unknown = misfit.large || more_than_noise || balance ||
                       (rest != nullptr && (share > kUnknownShare || remainder > kUnknownPerRow * rows));
  if (unknown) {
    diagnosis.verdict = "unknown_physics";
    diagnosis.detail = rest != nullptr ? "unknown_at_port" : "unknown_not_localised";
    if (rest != nullptr) report_unknown(*rest, share, diagnosis);
    // What is on the list and explains most may be there beside it, or be what the unknown looks like.
    if (share <= kUnknownShare && !balance) {
      report_effects(problem, search, belief, diagnosis);
      for (auto& effect : diagnosis.effects)
        if (!effect.id.starts_with("unknown@"))
          effect.probability = std::min(effect.probability, kDoubtBesideUnknown);
      const double unexplained =
          std::max({misfit.unexplained, (left * left - 1.0) * rows, leans ? lean.z * lean.z : 0.0});
      if (rest == nullptr) report_unknown_near(explained / (explained + unexplained), diagnosis);
      if (diagnosis.effects.empty()) report_unknown_leaning(lean, diagnosis);
    }
  } else if (best.set.empty()) {
    diagnosis.verdict = problem.trials.size() < kTooFewTrials ? "insufficient_data" : "consistent";
    diagnosis.detail = problem.trials.size() < kTooFewTrials ? "too_little_data" : "null";
  } else {
    diagnosis.verdict = "missing_physics";
    report_effects(problem, search, belief, diagnosis);
    bool classes = false;
    for (const auto& effect : diagnosis.effects) classes = classes || !effect.indistinguishable_from.empty();
    diagnosis.detail = classes ? "one_of_class" : rest != nullptr ? "known_and_rest" : "known";
    if (rest != nullptr) report_unknown(*rest, share, diagnosis);
  }
  report_broken_rules(problem.plant->broken_rules(clean.trials, clean.beliefs), diagnosis);
  report_data_faults(faults, diagnosis);
  const Residuals residuals =
      residuals_of(problem, search, diagnosis.unknown.empty() ? nullptr : &rest->family);
  report_errors(problem, residuals, diagnosis);
  report_residuals(problem, residuals, diagnosis);
  report_absent(problem, search, diagnosis);
  report_where(problem, search, residuals, diagnosis);
  report_traces(problem, clean, residuals, diagnosis);
  propose_next_trial(problem, clean, search, belief, rest, diagnosis);
  if (!diagnosis.effects.empty())
    diagnosis.corrected_model_toml = corrected_model(recordings, problem, diagnosis);
  diagnosis.simulations = problem.simulations;
  diagnosis.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  options.progress(1.0, "");
  return diagnosis;
}

}  // namespace sandhopper::diagnose
