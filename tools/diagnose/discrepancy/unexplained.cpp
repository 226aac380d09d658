#include "tools/diagnose/discrepancy/unexplained.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/diagnose/discrepancy/balance.hpp"
#include "tools/diagnose/discrepancy/law_limits.hpp"
#include "tools/diagnose/evidence/beside.hpp"
#include "tools/diagnose/evidence/calibration.hpp"
#include "tools/diagnose/fit/levels.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr std::size_t kLawsTold = 4;  // laws in the log

std::optional<FreeGain> law_of_balances(const Problem& problem, const Recordings& recordings) {
  std::vector<Balance> balances;
  for (std::size_t i = 0; i < recordings.trials.size(); ++i)
    for (auto& balance : problem.plant->balances(recordings.trials[i], recordings.beliefs[i]))
      balances.push_back(std::move(balance));
  for (auto& gain : laws_of_balances(problem, balances))
    if (is_law_of_balance(gain)) return std::move(gain);
  return std::nullopt;
}

// First gain that satisfies the condition.
template <class WillDo>
std::optional<FreeGain> first_of(const std::vector<FreeGain>& gains, WillDo will_do) {
  const auto it = std::ranges::find_if(gains, will_do);
  return it == gains.end() ? std::nullopt : std::optional(*it);
}

// A small sensor fault beside a large effect may only correct the form of the large one's law. In that case a
// free law of the plant explains more on held-out trials than the fault explains on the trials it was fitted
// to. With true faults the ratio was at most 0.87.
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
    log.push_back(fmt::format("in place of small faults, which gain {:.1f}: free law at {} of {}, {:.1f}",
                              of_faults, best_law->family.port, best_law->family.variable,
                              best_law->held_out));
  return first_of(gains, [&](const FreeGain& gain) { return is_law_in_place_of_faults(gain, of_faults); });
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
  // The named effects explain too little.
  if (m.outweighs && !search.best().set.empty()) m.large = m.noticeable = true;
  return m;
}

Unexplained unexplained_by(Problem& problem, const Search& search, const Belief& belief, bool faults,
                           BalanceLaw& balance, std::vector<std::string>& log) {
  const SetFit& best = search.best();
  Unexplained out;
  out.misfit = misfit_of(problem, search);
  const double explained = out.misfit.explained, rows = problem.rows();
  const BestNames names{rows, best.fit.deviance, explained, problem.plant->form_error()};
  const double least_gain = least_gain_of_law(names);

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
    out.law =
        first_of(beside, [&](const FreeGain& gain) { return is_more(gain) && is_law_beside(gain, rows); });
  const bool by_balance = (out.misfit.noticeable || noise_over_sensors(problem) > kQuietChannel) && balance();
  if (by_balance) {
    out.law = balance();
    log.push_back(fmt::format("balance at {}, {}: {:.0f} % of a trial's variance, p {:.1e}",
                              out.law->family.port, out.law->family.variable, 100.0 * out.law->held_out,
                              out.law->p_value));
    out.law->held_out = std::max(0.0, out.misfit.unexplained);
  }
  // If the best set leaves far more than the noise, it is no explanation and it may distort the free laws.
  // The evidence says which law acts, beside the set or in its place.
  std::vector<FreeGain> alone;
  if (out.misfit.large && !out.law) {
    alone = free_gains(problem, search.null().fit.point);
    const auto likely = likeliest_law(problem, search);
    if (likely) {
      log.push_back(fmt::format("most probable law: at {} of {}, beside {}", likely->family.port,
                                likely->family.variable,
                                likely->beside_nothing ? "nothing" : "the best set"));
      out.law = first_of(likely->beside_nothing ? alone : beside, [&](const FreeGain& gain) {
        return gain.family.port == likely->family.port && gain.family.variable == likely->family.variable &&
               is_likely_law(gain);
      });
    }
    if (!out.law)
      out.law = first_of(alone, [&](const FreeGain& gain) {
        return is_more(gain) && (gain.p_value < kLevel || problem.plant->motion_is_prescribed());
      });
    // Without the names the law explains what they explain, too. Only what they leave counts as left.
    if (out.law && explained > 0.0)
      out.law->held_out = std::min(out.law->held_out, std::max(0.0, out.misfit.unexplained));
  }
  // If a free law explains more on held-out trials than the best names on the trials they were fitted to, the
  // names are wrong.
  bool outdone = false;
  if (!best.set.empty() && !out.law && (!problem.plant->is_costly() || may_be_outdone(names))) {
    if (alone.empty()) alone = free_gains(problem, search.null().fit.point);
    out.law = first_of(alone, [&](const FreeGain& gain) { return outdoes_names(gain, names); });
    outdone = out.law.has_value();
  }
  bool form_outdoes = false;
  if (!out.law && !problem.plant->is_costly()) {
    out.law = in_place_of_small_faults(problem, search, log);
    outdone = form_outdoes = out.law.has_value();
  }

  // If the sensors' noise is known, a residual above it is something missing. The same holds for a nuisance
  // that all trials move alike.
  const LeftOver over = left_over_noise(problem, search.null().fit, best.fit);
  out.left = over.after;
  if (problem.plant->says_how_trials_differ(belief))
    out.shift = largest_common_shift(problem, best.fit.point);
  out.shift_is_unknown = is_unknown_shift(out.shift.z, !best.set.empty());
  // Not for costly plants: a hopper's accelerometers vibrate with the structure, and no belief states that
  // noise well.
  if (!problem.plant->is_costly()) out.noisy = noisiest_channel(problem);
  if (out.noisy)
    log.push_back(fmt::format("noisy channel: {}, {:.2f} times its sensor's noise", out.noisy->channel,
                              out.noisy->times));
  log.push_back(fmt::format("left: {:.2f} times the noise; largest shift alike in all trials: z = {:.1f} {}",
                            out.left, out.shift.z, out.shift.nuisance));
  const bool more_than_noise = !faults && (over.is_more_than_noise() || out.shift_is_unknown || out.noisy);
  if (more_than_noise && best.set.empty() && !out.law)
    out.law = first_of(beside, [&](const FreeGain& gain) {
      return !gain.family.sensor && is_more(gain) &&
             (over.is_more_than_noise() || gain.family.port.starts_with(out.shift.port));
    });

  const auto share = [&] {
    return out.law ? out.law->held_out / (out.law->held_out + std::max(explained, 0.0)) : 0.0;
  };
  const bool beyond_form = out.law && is_beyond_form(*out.law, share(), rows);
  // A law whose gain is within the noise and small beside the explained deviance is dropped.
  if (!outdone && !by_balance && !more_than_noise && best.fit.deviance < rows && !beyond_form)
    out.law.reset();
  out.share = share();
  out.unknown = out.misfit.large || more_than_noise || by_balance || form_outdoes || beyond_form;
  double left = out.remainder();
  // In the deviance's unit: the part of the explained deviance that would close as much of the excess.
  const double of_excess = over.share() < 1.0 && explained > 0.0
                               ? explained * over.share() / (1.0 - over.share())
                               : (out.left * out.left - 1.0) * rows;
  if (out.unknown)
    left = std::max({left, out.misfit.unexplained, of_excess,
                     out.shift_is_unknown ? out.shift.z * out.shift.z : 0.0,
                     // The part of the estimated noise that is not the sensor's own.
                     out.noisy ? (1.0 - std::pow(out.noisy->times, -2)) * rows : 0.0});
  out.gap_closed = best.set.empty() || explained <= 0.0 ? 0.0 : explained / (explained + std::max(0.0, left));
  // If a free law alone explains more on held-out trials than the names and a law together, the names are
  // wrong.
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
