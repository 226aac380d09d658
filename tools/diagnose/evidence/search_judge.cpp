#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>

#include "tools/diagnose/evidence/form_error.hpp"
#include "tools/diagnose/evidence/needed.hpp"
#include "tools/diagnose/evidence/search.hpp"
#include "tools/diagnose/evidence/search_parts.hpp"
#include "tools/diagnose/fit/linearise.hpp"

// Tests that decide if the trials need every effect of a set.
namespace sandhopper::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Edits of the simulation by effect `e` alone.
Edits edits_of(const Problem& problem, const Hypothesis& hypothesis, std::size_t e) {
  const auto& candidate = problem.candidates[hypothesis.candidates[e]];
  Edits edits;
  candidate.effect->apply(problem.context, candidate.channel, hypothesis.values[e], edits);
  return edits;
}

// Delay of each channel by this effect, s. The tolerances of these channels act in the same way and would
// absorb the effect, so `judge` excludes them. A late time stamp of a recorded drive means that the drive
// acts early: opposite sign.
std::map<std::string, double> delays_s(const Problem& problem, const Hypothesis& hypothesis, std::size_t e) {
  const Edits edits = edits_of(problem, hypothesis, e);
  std::map<std::string, double> delays;
  for (const auto& edit : edits.sensors)
    if (edit.kind == SensorEdit::Kind::delay_s)
      delays[edit.channel] += edit.channel == "actuator" ? -edit.value : edit.value;
  return delays;
}

// True if the effect only delays channels, by no more than the tolerance of their time stamps. For a recorded
// input, the tolerance is that of the channel with the longest sample time.
bool within_tolerance(const Problem& problem, const std::map<std::string, double>& delays) {
  if (delays.empty() || problem.tolerances.empty()) return false;
  double slowest_s = 0.0;
  for (const auto& tolerance : problem.tolerances) slowest_s = std::max(slowest_s, tolerance.of_sampling);
  return std::ranges::all_of(delays, [&](const auto& delay) {
    double scale_s = slowest_s;
    for (const auto& tolerance : problem.tolerances)
      if (tolerance.channel == delay.first) scale_s = tolerance.scale;
    return std::abs(delay.second) <= kMostTolerance * scale_s;
  });
}

// True if the effect only low-passes channels, by no more than averaging in the converter and interpolation
// between rows do. The mean over a time T has the variance T^2 / 12 in time, a standard deviation of T /
// sqrt(12).
bool within_conversion(const Problem& problem, const Hypothesis& hypothesis, std::size_t e) {
  const Edits edits = edits_of(problem, hypothesis, e);
  if (edits.sensors.empty() || !edits.belief.empty() || !edits.laws.empty()) return false;
  const double of_mean = 1.0 / std::sqrt(12.0), unsure = 1.5;
  return std::ranges::all_of(edits.sensors, [&](const SensorEdit& edit) {
    const double conversion = conversion_s(problem.context.belief, edit.channel);
    return edit.kind == SensorEdit::Kind::lag_s && conversion > 0.0 &&
           edit.value <= unsure * of_mean * std::hypot(conversion, problem.row_s);
  });
}

// True if several channels are delayed by the same time: only delays between channels can be measured.
bool late_together(const Problem& problem, const Hypothesis& hypothesis) {
  std::map<std::string, double> delays;
  for (std::size_t e = 0; e < hypothesis.candidates.size(); ++e)
    for (const auto& [channel, delay_s] : delays_s(problem, hypothesis, e)) delays[channel] += delay_s;
  if (delays.size() < 2) return false;
  const double first_s = delays.begin()->second;
  for (auto& [channel, delay_s] : delays) delay_s -= first_s;
  return within_tolerance(problem, delays);
}

// Channels whose readings the effect changes. Empty if it also changes the motion.
std::vector<std::string> channels_read(const Problem& problem, const Hypothesis& hypothesis, std::size_t e) {
  const Edits edits = edits_of(problem, hypothesis, e);
  std::vector<std::string> channels;
  for (const auto& edit : edits.sensors) {
    if (!problem.context.channels.contains(edit.channel) || edit.channel.ends_with("position_rad")) return {};
    channels.push_back(edit.channel);
  }
  if (!edits.belief.empty() || !edits.laws.empty()) channels.clear();
  return channels;
}

// Smallest drop of the deviance that exceeds the difference between two programs with the same equations: a
// limit per row, times the number of rows in which the effect can show.
double unnoticed(const Problem& problem, const Candidate& candidate,
                 const std::vector<std::string>& channels) {
  const double per_row =
      problem.plant->simulations_differ(channels.empty() ? port_of(candidate) : "readings");
  if (per_row == 0.0) return 0.0;
  double rows = 0.0;
  for (const auto& trial : problem.trials)
    for (const auto& row : trial->rows)
      rows +=
          channels.empty() || std::ranges::find(channels, problem.channels[row.channel]) != channels.end();
  return per_row * rows;
}

// Columns of one effect in a trial's Gram matrix, whose column 0 is the residual.
struct EffectColumns {
  std::vector<Index> own;          // its amplitudes
  std::vector<double> amplitudes;  // their values in typical sizes
  std::vector<Index> others;       // what is eliminated beside them
  VectorXd others_prior;           // and the information of its prior
};

// Evidence for the amplitudes of an effect, with the other columns eliminated. The effect is first added back
// to the residual, so that column 0 is the residual without it.
GroupGain gain_of(const std::vector<MatrixXd>& grams, const EffectColumns& effect) {
  const auto own = static_cast<Index>(effect.own.size());
  const auto others = static_cast<Index>(effect.others.size());
  std::vector<Index> columns{0};
  columns.insert(columns.end(), effect.own.begin(), effect.own.end());
  columns.insert(columns.end(), effect.others.begin(), effect.others.end());
  MatrixXd back = MatrixXd::Identity(1 + own + others, 1 + own + others);
  for (Index i = 0; i < own; ++i) back(1 + i, 0) = effect.amplitudes[static_cast<std::size_t>(i)];
  std::vector<TrialLinear> trials(grams.size());
  for (std::size_t t = 0; t < grams.size(); ++t)
    trials[t].gram = back.transpose() * grams[t](columns, columns) * back;
  std::vector<Index> first(effect.own.size());
  std::iota(first.begin(), first.end(), Index{1});
  return group_gain(eliminated(trials, 1 + own, others, effect.others_prior), first, kPriorOfAmplitude);
}

// The trials' Gram matrices without `forms`, the form errors of other effects.
std::vector<MatrixXd> grams_without(const std::vector<TrialLinear>& trials, Index kept,
                                    const std::vector<Index>& forms) {
  std::vector<Index> columns(static_cast<std::size_t>(kept));
  std::iota(columns.begin(), columns.end(), Index{0});
  const MatrixXd information = form_information(static_cast<Index>(forms.size()) / kFormKnots);
  std::vector<MatrixXd> grams;
  for (const auto& trial : trials)
    grams.push_back(without_forms(trial.gram, columns, forms, information).gram);
  return grams;
}

}  // namespace

void Search::judge(SetFit& result) {
  const Point& point = result.fit.point;
  const auto directions = parameter_directions(*problem_, point);
  // A single effect stands beside no other whose form could matter.
  const auto forms = result.set.size() > 1 ? forms_of(*problem_, point.hypothesis) : std::vector<FormOf>{};
  const auto linear =
      linearise_all(*problem_, point, directions,
                    {.forms = forms.empty() ? nullptr : &forms, .columns = columns_for(result.set)});
  const auto k = static_cast<Index>(directions.size());
  const auto parameters = static_cast<Index>(point.hypothesis.parameters());
  const VectorXd prior = prior_information(*problem_, point);
  double dispersion = 0.0, count = 0.0;
  Index first = 1;
  result.evidence.clear();
  result.judged = true;
  result.beside = deviances_without_one(result);
  result.needed = result.sound = true;
  result.hopeless = false;
  const auto plain = grams_without(linear, k + 1, {});
  for (std::size_t e = 0; e < point.hypothesis.candidates.size(); ++e) {
    const auto& candidate = problem_->candidates[point.hypothesis.candidates[e]];
    const auto width = static_cast<Index>(candidate.parameters.size());
    // The effect's own shape parameters are not eliminated: they must not absorb it.
    EffectColumns columns;
    for (Index i = 0; i < width; ++i) {
      const auto& p = candidate.parameters[static_cast<std::size_t>(i)];
      if (is_amplitude(candidate.parameters, static_cast<std::size_t>(i))) {
        columns.own.push_back(first + i);
        columns.amplitudes.push_back(point.hypothesis.values[e][static_cast<std::size_t>(i)] / p.typical);
      }
    }
    const auto delays = delays_s(*problem_, point.hypothesis, e);
    // A late input is the same as all channels early.
    const bool of_input = std::ranges::any_of(
        delays, [&](const auto& delay) { return !problem_->context.channels.contains(delay.first); });
    for (Index i = 1; i <= k; ++i) {
      const bool own = i >= first && i < first + width;
      const bool same_as_own =
          i > parameters &&
          (of_input ||
           delays.contains(problem_->tolerances[static_cast<std::size_t>(i - 1 - parameters)].channel));
      if (!own && !same_as_own) columns.others.push_back(i);
    }
    const auto n_others = static_cast<Index>(columns.others.size());
    columns.others_prior.resize(n_others);
    // If a tolerance is already at its limit in the fit without the effect, it cannot absorb the effect: hold
    // it.
    const auto parent = sets_.find(without(result.set, point.hypothesis.candidates[e]));
    const Point& there = parent != sets_.end() ? parent->second.fit.point : null().fit.point;
    const VectorXd prior_there = prior_information(*problem_, there).tail(k - parameters);
    for (Index i = 0; i < n_others; ++i) {
      const Index direction = columns.others[static_cast<std::size_t>(i)] - 1;
      columns.others_prior[i] = prior[direction];
      if (const Index tolerance = direction - parameters; tolerance >= 0)
        columns.others_prior[i] = std::max(columns.others_prior[i], prior_there[tolerance]);
    }
    const auto group = gain_of(plain, columns);
    // Beside other effects also with their laws free to have another form: an effect that only corrects that
    // form is not needed. The form errors take up scatter between trials, too, so both tests count.
    std::vector<Index> of_others;
    for (Index i = 0; i < static_cast<Index>(forms.size()) * kFormKnots; ++i)
      if (i / kFormKnots != static_cast<Index>(e)) of_others.push_back(k + 1 + i);
    const auto beyond_forms =
        of_others.empty() ? group : gain_of(grams_without(linear, k + 1, of_others), columns);
    EffectEvidence evidence;
    evidence.candidate = point.hypothesis.candidates[e];
    evidence.evidence = group.evidence;
    evidence.gain = group.gain;
    evidence.typicals = typicals_of(*problem_, point.hypothesis, e);
    const double p_value = std::max(group.evidence.p_value(), beyond_forms.evidence.p_value());
    evidence.p_value = std::min(1.0, p_value * static_cast<double>(problem_->candidates.size()));
    for (std::size_t i = 0; i < candidate.parameters.size(); ++i) {
      const auto& p = candidate.parameters[i];
      const double value = point.hypothesis.values[e][i];
      evidence.at_bound =
          evidence.at_bound || (p.other_law_above && value >= 0.99 * p.high) ||
          (is_amplitude(candidate.parameters, i) && (p.at_high(value) || (p.at_low(value) && p.low != 0.0)));
    }
    if (within_tolerance(*problem_, delays) || within_conversion(*problem_, point.hypothesis, e))
      result.sound = false;
    evidence.dispersion = std::max(1.0, group.evidence.dispersion());
    dispersion += group.evidence.dispersion();
    ++count;
    result.evidence.push_back(std::move(evidence));
    first += width;
  }
  if (late_together(*problem_, point.hypothesis)) result.sound = false;
  result.dispersion = count > 0.0 ? std::max(1.0, dispersion / count) : 1.0;
  const auto strongest = std::ranges::min_element(result.evidence, {}, &EffectEvidence::p_value);
  for (std::size_t e = 0; e < result.evidence.size(); ++e) {
    auto& evidence = result.evidence[e];
    const auto parent = without(result.set, evidence.candidate);
    const auto fitted = sets_.find(parent);
    const double drop =
        fitted == sets_.end() ? evidence.gain : fitted->second.fit.deviance - result.fit.deviance;
    // Flip signs at the set without this effect, against all candidates there. If the linear gain at the fit
    // is mostly real, also flip there, as if all candidates had been tried (Bonferroni).
    if (screens_.contains(parent)) {
      std::vector<TrialEvidence> rivals;
      std::size_t chosen = 0;
      for (const auto& s : screened(parent)) {
        if (s.candidate == evidence.candidate) chosen = rivals.size();
        rivals.push_back(s.evidence);
      }
      if (!rivals.empty()) evidence.flip_p_value = sign_flip_p_value(rivals, chosen, 1);
      if (is_mostly_true(drop, evidence.gain))
        evidence.flip_p_value =
            std::min(evidence.flip_p_value, static_cast<double>(problem_->candidates.size()) *
                                                sign_flip_p_value({evidence.evidence}, 0, 1));
    } else {
      evidence.flip_p_value = 0.0;
    }
    const bool has_parent = fitted != sets_.end();
    const Need need = need_of(
        evidence, {.trials = problem_->trials.size(),
                   .effects = result.set.size(),
                   .candidates = problem_->candidates.size(),
                   .rows = problem_->rows(),
                   .form_error = problem_->plant->form_error(),
                   .is_strongest = &evidence == &*strongest,
                   .drop = drop,
                   .came_true = !has_parent || comes_true(fitted->second.fit, result.fit, evidence.gain),
                   .removes_offset = has_parent && removes_common_shift(fitted->second.fit, result.fit),
                   .explained = null().fit.deviance - result.fit.deviance,
                   .between_programs = unnoticed(*problem_, problem_->candidates[evidence.candidate],
                                                 channels_read(*problem_, point.hypothesis, e))});
    result.sound = result.sound && need.is_sound;
    result.needed = result.needed && result.sound && need.is_needed;
    result.hopeless = result.hopeless || need.is_hopeless;
  }
}

}  // namespace sandhopper::diagnose
