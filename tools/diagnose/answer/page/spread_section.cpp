#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/diagnose/answer/page/diagnosis_page.hpp"
#include "tools/diagnose/answer/spread_text.hpp"
#include "tools/diagnose/model/digits.hpp"
#include "tools/diagnose/model/quantity.hpp"

namespace sandhopper::diagnose {
namespace {

// Label and scale of a fitted number, as the sentences about it (spread_text) have it: shares in %, short
// lengths in mm.
struct Shown {
  explicit Shown(const TrialToTrial& n) {
    const auto quantity = quantity_of(n.name);
    const bool is_share = n.name.ends_with("_relative");
    const bool is_short = quantity.unit == "m" && std::abs(n.believed_sd) < kShort_m;
    label = is_share   ? in_words(subject_of(n)) + ", %"
            : is_short ? quantity.words + ", mm"
                       : quantity.label();
    scale = is_share ? 100.0 : is_short ? 1e3 : 1.0;
  }
  std::string label;
  double scale = 1.0;
};

// Trials of any fitted number, in their order.
std::vector<std::string> trials_of(const Diagnosis& d) {
  std::vector<std::string> trials;
  for (const auto& n : d.trial_to_trial)
    for (const auto& value : n.values)
      if (std::ranges::find(trials, value.trial) == trials.end()) trials.push_back(value.trial);
  return trials;
}

StudyTable numbers_table(const Diagnosis& d) {
  StudyTable table;
  // With nothing found, before and after are the same fit.
  const bool changed = is_changed(d);
  table.columns = {"fitted in each trial", "believed sd", changed ? "mean as believed" : "mean",
                   changed ? "sd as believed" : "sd"};
  if (changed)
    table.columns.insert(table.columns.end(), {"mean with what was found", "sd with what was found"});
  table.columns.emplace_back("largest value, in believed sd");
  for (const auto& n : d.trial_to_trial) {
    double furthest = 0.0;
    for (const auto& value : n.values) furthest = std::max(furthest, std::abs(value.after));
    const Shown shown(n);
    const auto digits = [&](double value, double sd) {
      return to_digits_of(shown.scale * value, shown.scale * sd);
    };
    std::vector<std::string> row{shown.label, plain_number(shown.scale * n.believed_sd, 3)};
    if (changed) {
      row.push_back(digits(n.mean_before, n.sd_before));
      row.push_back(digits(n.sd_before, n.sd_before));
    }
    row.push_back(digits(n.mean_after, n.sd_after));
    row.push_back(digits(n.sd_after, n.sd_after));
    row.push_back(n.believed_sd > 0.0 ? plain_number(furthest / n.believed_sd, 2) : "");
    table.rows.push_back(std::move(row));
    table.row_marks.emplace_back(n.exceeds_after() ? "bad" : "");
  }
  table.note =
      "Parameters that are fitted in each trial beside the model; sd: standard deviation. A marked one "
      "differs by more than the spread that the belief states for it (1 % by chance, over all trials and "
      "numbers): it may have absorbed something that the model lacks. So may one whose mean lies many "
      "believed sd from zero.";
  return table;
}

StudyTable values_table(const Diagnosis& d) {
  StudyTable table;
  table.title = is_changed(d) ? "Their values, with what was found" : "Their values";
  table.columns = {"trial"};
  for (const auto& n : d.trial_to_trial) table.columns.push_back(Shown(n).label);
  bool exceeded = false;
  for (const auto& trial : trials_of(d)) {
    std::vector<std::string> row{trial};
    bool exceeds = false;
    for (const auto& n : d.trial_to_trial) {
      const auto value = std::ranges::find(n.values, trial, &SpreadValue::trial);
      const bool is_there = value != n.values.end();
      const bool is_marked = is_there && value->exceeds_after;
      const double scale = Shown(n).scale;
      row.push_back(
          is_there ? to_digits_of(scale * value->after, scale * n.sd_after) + (is_marked ? " !" : "") : "");
      exceeds = exceeds || is_marked;
    }
    table.rows.push_back(std::move(row));
    table.row_marks.emplace_back(exceeds ? "bad" : "");
    exceeded = exceeded || exceeds;
  }
  if (exceeded) table.note = "!: further from zero than the believed spread allows.";
  return table;
}

}  // namespace

StudySection trial_to_trial_section(const Diagnosis& d) {
  StudySection section{"What differs from trial to trial", {}};
  if (const auto beyond = beyond_spread(d); !beyond.empty())
    section.items.emplace_back("The answer holds only if " + beyond + ".");
  section.items.emplace_back(numbers_table(d));
  section.items.emplace_back(values_table(d));
  return section;
}

}  // namespace sandhopper::diagnose
