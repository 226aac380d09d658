#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "tools/diagnose/answer/report_parts.hpp"
#include "tools/diagnose/discrepancy/misfit.hpp"
#include "tools/diagnose/fit/levels.hpp"
#include "tools/diagnose/fit/statistics.hpp"

namespace sandhopper::diagnose {
namespace {

// Index of the nuisance in this trial. None: the trial does not have it, or several share the name, as the
// knots along depth do.
std::optional<std::size_t> index_of(const TrialModel& trial, const std::string& name) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < trial.trial_nuisances.size(); ++i) {
    if (trial.trial_nuisances[i].name != name) continue;
    if (found) return std::nullopt;
    found = i;
  }
  return found;
}

// Names of the nuisances in the order in which the trials first have them.
std::vector<std::string> names_of_nuisances(const Problem& problem) {
  std::vector<std::string> names;
  for (const auto& trial : problem.trials)
    for (const auto& nuisance : trial->trial_nuisances)
      if (std::ranges::find(names, nuisance.name) == names.end()) names.push_back(nuisance.name);
  return names;
}

// Spread that the belief gives this nuisance; 0: none.
double stated_spread(const Belief& belief, const std::string& name) {
  for (const auto& spread : belief.key_spreads)
    if (spread.name == name) return spread.sd;
  return belief.value("spread." + name);
}

std::pair<double, double> mean_and_sd(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double sum = 0.0, squares = 0.0;
  for (const double value : values) sum += value;
  for (const double value : values) squares += std::pow(value - sum / n, 2);
  return {sum / n, std::sqrt(squares / (n - 1.0))};
}

// 1: each group's values lie above those of the group before; -1: below; 0: neither.
int order_of(const std::map<double, std::vector<double>>& groups) {
  bool rises = true, falls = true;
  for (auto next = std::next(groups.begin()); next != groups.end(); ++next) {
    const auto [low, high] = std::ranges::minmax(next->second);
    const auto [low_before, high_before] = std::ranges::minmax(std::prev(next)->second);
    rises = rises && low > high_before;
    falls = falls && high < low_before;
  }
  return rises ? 1 : falls ? -1 : 0;
}

// Probability that n values without any relation to the groups, of g_k values each, are in order:
//   2 prod g_k! / n!
double chance_of_order(const std::map<double, std::vector<double>>& groups) {
  double log_chance = std::log(2.0), n = 0.0;
  for (const auto& [setting, values] : groups) {
    log_chance += std::lgamma(static_cast<double>(values.size()) + 1.0);
    n += static_cast<double>(values.size());
  }
  return std::exp(log_chance - std::lgamma(n + 1.0));
}

// "falls with plate_diameter_m": set-up numbers with which all values are in order, if that is no chance.
std::string order_in_words(const std::vector<SpreadValue>& values, const std::vector<Trial>& recorded) {
  std::map<std::string, std::map<double, std::vector<double>>> by_key;
  std::map<std::string, std::size_t> count;
  for (const auto& value : values) {
    const auto trial = std::ranges::find(recorded, value.trial, &Trial::name);
    if (trial == recorded.end()) return "";
    for (const auto& [key, setting] : trial->setup) {
      by_key[key][setting].push_back(value.after);
      ++count[key];
    }
  }
  std::erase_if(by_key, [&](const auto& entry) {
    return count[entry.first] < values.size() || entry.second.size() < 2;
  });
  std::string text;
  for (const auto& [key, groups] : by_key) {
    const int order = order_of(groups);
    if (order == 0 || chance_of_order(groups) * static_cast<double>(by_key.size()) > kSignificance) continue;
    text += (text.empty() ? "" : ", ") + std::string(order > 0 ? "rises with " : "falls with ") + key;
  }
  return text;
}

// Marks the values that the believed spreads do not allow.
void mark_what_exceeds(const Belief& belief, std::vector<TrialToTrial>& entries) {
  double tests = 0.0;
  for (const auto& nuisance : entries)
    if (stated_spread(belief, nuisance.name) > 0.0) tests += static_cast<double>(nuisance.values.size());
  if (tests == 0.0) return;
  const double most = normal_quantile(kSignificance / tests);
  for (auto& nuisance : entries) {
    if (stated_spread(belief, nuisance.name) <= 0.0) continue;
    for (auto& value : nuisance.values) {
      value.exceeds_before = std::abs(value.before) > most * nuisance.believed_sd;
      value.exceeds_after = std::abs(value.after) > most * nuisance.believed_sd;
    }
  }
}

// Standard deviation that the belief gives the nuisance. A fit may have narrowed it to the spread that it
// saw.
double believed_sd(const Problem& problem, const Nuisance& nuisance) {
  return std::max(nuisance.sd, stated_spread(problem.context.belief, nuisance.name));
}

// True if a mean that is not zero says something of the rig.
bool shift_is_evidence(const Nuisance& nuisance) { return nuisance.shift_is_evidence && !nuisance.is_own; }

// Marks the unstated spreads whose mean is not zero; Bonferroni over them.
void mark_common_shifts(std::vector<TrialToTrial>& entries) {
  const auto tests = static_cast<double>(std::ranges::count_if(entries, &TrialToTrial::shifts_alike));
  for (auto& nuisance : entries) {
    const auto n = static_cast<double>(nuisance.values.size());
    const double error = nuisance.sd_after / std::sqrt(n);
    nuisance.shifts_alike = nuisance.shifts_alike && nuisance.values.size() >= kTooFewTrials && error > 0.0 &&
                            student_t_two_sided(nuisance.mean_after / error, n - 1.0) < kSignificance / tests;
  }
}

}  // namespace

void report_trial_to_trial(const Problem& problem, const Search& search, const std::vector<Trial>& recorded,
                           Diagnosis& diagnosis) {
  const auto &null = search.null().fit.point.nuisances, &best = search.best().fit.point.nuisances;
  for (const auto& name : names_of_nuisances(problem)) {
    TrialToTrial entry;
    entry.name = name;
    std::vector<double> before, after;
    for (std::size_t t = 0; t < problem.trials.size(); ++t) {
      const auto i = index_of(*problem.trials[t], name);
      if (!i) continue;
      const Nuisance& nuisance = problem.trials[t]->trial_nuisances[*i];
      entry.believed_sd = believed_sd(problem, nuisance);
      entry.shifts_alike = shift_is_evidence(nuisance);
      before.push_back(null[t][*i]);
      after.push_back(best[t][*i]);
      entry.values.push_back({problem.trials[t]->name, before.back(), after.back()});
    }
    if (entry.values.size() < 2) continue;
    std::tie(entry.mean_before, entry.sd_before) = mean_and_sd(before);
    std::tie(entry.mean_after, entry.sd_after) = mean_and_sd(after);
    entry.is_default = stated_spread(problem.context.belief, name) <= 0.0;
    for (const auto& number : diagnosis.belief)
      if (number.key == "spread." + name) entry.is_default = number.source.starts_with("default");
    entry.shifts_alike = entry.shifts_alike && entry.is_default;
    diagnosis.trial_to_trial.push_back(std::move(entry));
  }
  mark_what_exceeds(problem.context.belief, diagnosis.trial_to_trial);
  mark_common_shifts(diagnosis.trial_to_trial);
  for (auto& entry : diagnosis.trial_to_trial) {
    if (entry.exceeds_after())
      entry.goes_with = order_in_words(entry.values, recorded);
    else if (!entry.shifts_alike)
      continue;
    if (diagnosis.verdict == Verdict::consistent) diagnosis.detail = Detail::only_beyond_spread;
  }
}

}  // namespace sandhopper::diagnose
