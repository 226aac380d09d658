#include "tools/diagnose/discrepancy/unexplained.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/diagnose/discrepancy/balance.hpp"
#include "tools/diagnose/evidence/calibration.hpp"

namespace sandhopper::diagnose {
namespace {

// Of what can be explained: more than this the library does not say. Of what acts in the plant itself, beside
// right names, a law of free form says up to 0.08 (a second program's 105 campaigns), of a sensor 0.16.
constexpr double kUnknownShare = 0.30, kUnknownShareOfPlant = 0.16;
constexpr double kUnknownSignificance = 0.003;
constexpr double kSmallestLaw =
    0.1;  // of the port's scale, at its largest: what is smaller matters to nobody
constexpr double kUnknownShareOfDeviance = 0.03;  // a null campaign's own misfits stay below
constexpr double kUnknownPerRow = 0.3;  // so much of the noise's own power left is no matter of form
constexpr double kMisfitSignificance = 0.05;
constexpr double kOutdone = 1.3;
constexpr double kLeastPerRow = 0.75;     // of the deviance: what no law gets below is not worth asking for
constexpr double kMostTrialsLeft = 0.75;  // that a law must be better for
constexpr double kUnknownGain = 25.0;
constexpr double kUnknownGainPerRow = 0.004;  // less moves nothing by a noticeable part of the floor
constexpr double kBalanceShare = 0.25;  // of a trial's variance; with nothing missing it stays below 0.05
constexpr double kBalanceSignificance = 0.01;
// Of trials that lean alike, beside names (with the right ones up to 3.3) and without any (nulls up to 2.9).
constexpr double kLeansBeside = 4.5, kLeansAlone = 6.0;
constexpr double kMoreThanNoise = 1.35;  // of it left; nulls of seed 9023 up to 1.00, of 9025 up to 1.13
// Of the noise over the sensors' own with the best set in place: with nothing missing it stays below.
constexpr double kNoiseHidesMuch = 1.3;
constexpr std::size_t kLawsTold = 4;

// Not a law of the drive's torque: what the list says of the actuator looks like that; nor of time, which
// goes with everything.
std::optional<FreeGain> law_of_balances(const Problem& problem, const Recordings& recordings) {
  std::vector<Balance> balances;
  for (std::size_t i = 0; i < recordings.trials.size(); ++i)
    for (auto& balance : problem.plant->balances(recordings.trials[i], recordings.beliefs[i]))
      balances.push_back(std::move(balance));
  for (auto& gain : laws_of_balances(problem, balances))
    if (gain.family.variable != "torque_Nm" && gain.family.variable != "t_s" &&
        gain.held_out > kBalanceShare && gain.p_value < kBalanceSignificance &&
        gain.trials_better >= kMostTrialsLeft)
      return std::move(gain);
  return std::nullopt;
}

// The first of them that will do.
template <class WillDo>
std::optional<FreeGain> first_of(const std::vector<FreeGain>& gains, WillDo will_do) {
  const auto it = std::ranges::find_if(gains, will_do);
  return it == gains.end() ? std::nullopt : std::optional(*it);
}

// Beside a large effect a small fault of a sensor may be no more than how the large one differs in form. Then
// a law of free form in the plant, in the fault's place, says more of trials it has not seen than the fault
// of those it was fitted to; with true faults it said up to 0.87 of that (seed 9043).
std::optional<FreeGain> in_place_of_small_faults(const Problem& problem, const Search& search,
                                                 std::vector<std::string>& log) {
  const SetFit& best = search.best();
  std::vector<std::size_t> rest;
  for (const auto c : best.set)
    if (problem.candidates[c].channel.empty()) rest.push_back(c);
  const auto without = search.sets().find(rest);
  if (rest.empty() || rest.size() == best.set.size() || without == search.sets().end()) return std::nullopt;
  const double of_faults = without->second.fit.deviance - best.fit.deviance;
  const double of_all = search.null().fit.deviance - best.fit.deviance;
  if (of_faults > kSmallShare * of_all) return std::nullopt;
  const auto gains = free_gains(problem, without->second.fit.point);
  if (const auto best_law = first_of(gains, [](const FreeGain& gain) { return !gain.family.sensor; }))
    log.push_back(fmt::format("in the place of small faults, which gain {:.1f}: free law at {} of {}, {:.1f}",
                              of_faults, best_law->family.port, best_law->family.variable,
                              best_law->held_out));
  return first_of(gains, [&](const FreeGain& gain) {
    return !gain.family.sensor && gain.held_out > std::max(of_faults, kUnknownGain) &&
           gain.p_value < kMisfitSignificance && gain.trials_better >= kMostTrialsLeft;
  });
}

}  // namespace

const std::optional<FreeGain>& BalanceLaw::operator()() {
  if (!asked_) law_ = law_of_balances(*problem_, *recordings_);
  asked_ = true;
  return law_;
}

Misfit misfit_of(const Problem& problem, const Search& search) {
  std::vector<TrialMisfit> trials;
  for (std::size_t t = 0; t < problem.trials.size(); ++t)
    trials.push_back(
        {search.best().fit.trial_deviance[t], static_cast<double>(problem.trials[t]->rows.size())});
  auto m = misfit_of(trials, search.null().fit.deviance, problem.plant->motion_is_prescribed());
  if (m.outweighs && !search.best().set.empty()) m.large = m.noticeable = true;  // names that say little
  return m;
}

Unexplained unexplained_by(const Problem& problem, const Search& search, const Belief& belief, bool faults,
                           BalanceLaw& balance, std::vector<std::string>& log) {
  const SetFit& best = search.best();
  Unexplained out;
  out.misfit = misfit_of(problem, search);
  const double explained = out.misfit.explained, rows = problem.rows(), form = problem.plant->form_error();
  const double least_gain =
      std::max({kUnknownGain, kUnknownGainPerRow * rows,
                std::min(kUnknownShareOfDeviance, 10.0 * form) * best.fit.deviance, form * explained});

  const auto is_more = [&](const FreeGain& gain) {
    return gain.held_out > std::max(least_gain, problem.plant->simulations_differ(gain.family.port) * rows);
  };

  const auto beside = free_gains(problem, best.fit.point);
  for (std::size_t i = 0; i < beside.size() && i < kLawsTold; ++i)
    log.push_back(fmt::format(
        "free law at {} of {}: held-out gain {:.1f}, p {:.1e}, better in {:.0f} %, largest {:.3g}",
        beside[i].family.port, beside[i].family.variable, beside[i].held_out, beside[i].p_value,
        100.0 * beside[i].trials_better, beside[i].family.scale * beside[i].size.cwiseAbs().maxCoeff()));
  if (problem.trials.size() >= kTooFewTrials)
    out.law = first_of(beside, [&](const FreeGain& gain) {
      // Where few of the trials show it most, they show it the better for that.
      const bool much = gain.held_out > kUnknownPerRow * rows;
      return is_more(gain) && gain.p_value < (much ? kMisfitSignificance : kUnknownSignificance) &&
             gain.trials_better >= kMostTrialsLeft && gain.size.cwiseAbs().maxCoeff() > kSmallestLaw;
    });
  const bool by_balance =
      (out.misfit.noticeable || noise_over_sensors(problem) > kNoiseHidesMuch) && balance();
  if (by_balance) {
    out.law = balance();
    log.push_back(fmt::format("balance at {}, {}: {:.0f} % of a trial's variance, p {:.1e}",
                              out.law->family.port, out.law->family.variable, 100.0 * out.law->held_out,
                              out.law->p_value));
    out.law->held_out = std::max(0.0, out.misfit.unexplained);
  }
  // Where the best set leaves far more than the noise, it is no explanation, and it bends the laws of free
  // form, too: they are asked again without it.
  std::vector<FreeGain> alone;
  if (out.misfit.large && !out.law) {
    alone = free_gains(problem, search.null().fit.point);
    out.law = first_of(alone, [&](const FreeGain& gain) {
      return is_more(gain) && (gain.p_value < kMisfitSignificance || problem.plant->motion_is_prescribed());
    });
  }
  // Where a law of free form says more of trials it has not seen than the best names of those they were
  // fitted to, the names are not it.
  bool outdone = false;
  const bool may_be_outdone =
      !problem.plant->is_costly() ||
      best.fit.deviance - (kOutdone - 1.0) * explained - least_gain > kLeastPerRow * rows;
  if (!best.set.empty() && !out.law && may_be_outdone) {
    if (alone.empty()) alone = free_gains(problem, search.null().fit.point);
    out.law = first_of(alone, [&](const FreeGain& gain) {
      return gain.held_out > kOutdone * explained + least_gain && gain.p_value < kMisfitSignificance &&
             gain.trials_better >= kMostTrialsLeft;
    });
    outdone = out.law.has_value();
  }
  bool form_outdoes = false;
  if (!out.law && !problem.plant->is_costly()) {
    out.law = in_place_of_small_faults(problem, search, log);
    outdone = form_outdoes = out.law.has_value();
  }

  // Where the sensors are known and more is left than their noise, that is something, whatever it is; so it
  // is where it bends what differs from trial to trial by so much in all of them.
  out.left = left_over_noise(problem, best.fit);
  if (problem.plant->says_how_trials_differ(belief)) out.lean = largest_lean(problem, best.fit.point);
  out.leans = std::abs(out.lean.z) > (best.set.empty() ? kLeansAlone : kLeansBeside);
  // A hopper's accelerometers shake with its structure; how much, a belief hardly says.
  if (!problem.plant->is_costly()) out.loud = loudest_channel(problem);
  if (out.loud)
    log.push_back(fmt::format("loud: {}, {:.2f} times its sensor", out.loud->channel, out.loud->times));
  log.push_back(fmt::format("left: {:.2f} times the noise; all trials lean by {:.1f} {}", out.left,
                            out.lean.z, out.lean.nuisance));
  const bool more_than_noise = !faults && (out.left > kMoreThanNoise || out.leans || out.loud);
  if (more_than_noise && best.set.empty() && !out.law)
    out.law = first_of(beside, [&](const FreeGain& gain) {
      return !gain.family.sensor && is_more(gain) &&
             (out.left > kMoreThanNoise || gain.family.port.starts_with(out.lean.port));
    });

  const auto share = [&] {
    return out.law ? out.law->held_out / (out.law->held_out + std::max(explained, 0.0)) : 0.0;
  };
  const double most_share = out.law && !out.law->family.sensor ? kUnknownShareOfPlant : kUnknownShare;
  // What lies within the noise and is little, beside what was found and beside the noise, is nothing unknown.
  if (!outdone && !by_balance && !more_than_noise && best.fit.deviance < rows && share() <= most_share &&
      out.remainder() <= kUnknownPerRow * rows)
    out.law.reset();
  out.share = share();
  out.unknown = out.misfit.large || more_than_noise || by_balance || form_outdoes ||
                (out.law && (out.share > most_share || out.remainder() > kUnknownPerRow * rows));
  double left = out.remainder();
  if (out.unknown)
    left = std::max({left, out.misfit.unexplained, (out.left * out.left - 1.0) * rows,
                     out.leans ? out.lean.z * out.lean.z : 0.0,
                     // Of the noise as estimated, in which the deviance is counted, what no sensor makes.
                     out.loud ? (1.0 - std::pow(out.loud->times, -2)) * rows : 0.0});
  out.gap_closed = best.set.empty() || explained <= 0.0 ? 0.0 : explained / (explained + std::max(0.0, left));
  // A law of free form that alone says more of trials it has not seen than the names and a law beside them:
  // the names are not it.
  if (out.unknown && out.law && !best.set.empty()) {
    if (alone.empty()) alone = free_gains(problem, search.null().fit.point);
    const double together = explained + out.law->held_out;
    if (auto instead = first_of(
            alone, [&](const FreeGain& gain) { return !gain.family.sensor && gain.held_out > together; })) {
      out.law = std::move(instead);
      out.share = 1.0;
      out.gap_closed = 0.0;
    }
  }
  log.push_back(fmt::format(
      "explained {:.1f}, left {:.1f} beyond the noise, rest {:.1f} ({:.1f} %), {} rows, gap closed {:.3f}",
      explained, out.misfit.unexplained, out.remainder(), 100.0 * out.share, rows, out.gap_closed));
  return out;
}

}  // namespace sandhopper::diagnose
