#include "tools/calibrate/page.hpp"

#include <fmt/format.h>

#include "tools/calibrate/write.hpp"
#include "tools/report/digits.hpp"

namespace sandhopper::calibrate {
namespace {

StudyTable values_table(const Outcome& outcome) {
  StudyTable table{.columns = {"key", "unit", "before", "after", "95 % interval, ±"}};
  table.text_columns = 2;
  table.whole = true;
  for (const auto& target : outcome.targets)
    for (const auto& value : target.values)
      table.rows.push_back({value.key, value.unit, plain_number(value.before, 6),
                            digits_by(value.after, value.ci95).value_or(value_text(value)),
                            value.ci95 > 0.0 ? plain_number(value.ci95, 2) : "exact"});
  return table;
}

}  // namespace

Study page_of(const Outcome& outcome, const std::string& name, const std::string& date) {
  Study study;
  study.title = "Calibration: " + name;
  const bool good = outcome.refusals.empty();
  study.verdict = good ? "The fit is good." : "Refused: the configuration was left as it is.";
  study.verdict_mark = good ? "good" : "bad";
  study.facts = {{"date", date},
                 {"points", std::to_string(outcome.points)},
                 {"residual, rms", plain_number(outcome.residual_rms, 3) + " " + outcome.residual_unit}};
  for (const auto& refusal : outcome.refusals)
    study.warnings.push_back(fmt::format("{}: {}. Cure: {}.", refusal.reason, refusal.text, refusal.cure));
  for (const auto& note : outcome.notes) study.warnings.push_back("Note: " + note + ".");
  StudySection values{.title = "Values"};
  values.items.emplace_back(values_table(outcome));
  if (!outcome.targets.empty()) study.sections.push_back(values);
  study.sections.insert(study.sections.end(), outcome.sections.begin(), outcome.sections.end());
  return study;
}

}  // namespace sandhopper::calibrate
