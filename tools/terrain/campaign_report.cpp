#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/terrain/campaign_analysis.hpp"
#include "tools/terrain/figure_text.hpp"

namespace sandhopper {
namespace {

using Json = nlohmann::ordered_json;
using ResultPointers = std::vector<const TrialResult*>;

TrialKind kind_of(const TrialResult& result) {
  const auto& names = EnumNames<TrialKind>::value;
  return static_cast<TrialKind>(std::find(names.begin(), names.end(), result.kind) - names.begin());
}

template <class Takes>
ResultPointers usable_results(const CampaignResults& results, Takes&& takes) {
  ResultPointers taken;
  for (const auto& result : results.results)
    if (result.usable && takes(result)) taken.push_back(&result);
  return taken;
}

Json pooled_json(const std::vector<PooledQuantity>& pooled) {
  Json json = Json::object();
  const auto number = [](double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); };
  for (const auto& q : pooled)
    json[q.name] = {{"value", number(q.value)},
                    {"ci95", {number(q.ci95_low), number(q.ci95_high)}},
                    {"standard_deviation", number(q.standard_deviation)},
                    {"trials", q.trials}};
  return json;
}

// Pools the trials with equal set-up numbers separately.
Json pooled_by_setup(const ResultPointers& results) {
  constexpr std::size_t kMostGroups = 200;
  std::vector<std::pair<const TrialResult*, ResultPointers>> groups;
  for (const auto* result : results) {
    const auto same = std::find_if(groups.begin(), groups.end(),
                                   [&](const auto& group) { return group.first->setup == result->setup; });
    if (same != groups.end())
      same->second.push_back(result);
    else if (groups.size() <= kMostGroups)
      groups.push_back({result, {result}});
  }
  Json list = Json::array();
  if (groups.size() < 2 || groups.size() > kMostGroups) return list;
  for (const auto& [first, trials] : groups) {
    if (trials.size() < 2) continue;
    Json setup = Json::object();
    for (const auto& [key, value] : first->setup) setup[key] = value;
    list.push_back({{"setup", setup}, {"figures", pooled_json(pool_quantities(trials))}});
  }
  return list;
}

StudyTable pooled_table(const std::vector<PooledQuantity>& pooled) {
  StudyTable table{
      .title = "Mean over trials",
      .columns = {"figure", "unit", "mean", "95 % interval", "sd from trial to trial", "trials"},
      .text_columns = 2,
      .note =
          "Intervals come from the spread between trials (Student's t); samples of one trial are "
          "never counted as independent."};
  for (const auto& q : pooled) {
    const double scale = page_scale(q.name);
    table.rows.push_back(
        {figure_title(q.name), figure_unit(q.name),
         value_text(scale * q.value, scale * q.ci95_low, scale * q.ci95_high),
         interval_text(scale * q.ci95_low, scale * q.ci95_high),
         q.trials < 2 ? std::string("–")
                      : value_text(scale * q.standard_deviation, 0.0, 2.0 * scale * q.standard_deviation),
         fmt::format("{}", q.trials)});
  }
  return table;
}

StudySection findings_section(const std::vector<FindingGroup>& findings) {
  StudySection section{.title = "Recordings: faults and remarks"};
  if (findings.empty()) {
    section.items.emplace_back(std::string("Nothing was wrong with the recordings."));
    return section;
  }
  StudyTable table{.columns = {"where", "column", "what", "cure", "costs", "trials"}, .text_columns = 5};
  for (const auto& [finding, trials] : findings) {
    const auto where = finding->line > 0
                           ? fmt::format("{}:{}:{}", finding->file, finding->line, finding->column)
                           : finding->file;
    table.rows.push_back({where, finding->channel, finding->what, finding->cure,
                          std::string(cost_text(finding->severity)), fmt::format("{}", trials)});
  }
  section.items.emplace_back(std::move(table));
  return section;
}

StudySection ruled_out_section(const std::vector<RuledOut>& reasons) {
  StudySection section{.title = "What these recordings cannot say"};
  StudyTable table{.columns = {"conclusion", "trials"}};
  for (const auto& [reason, trials] : reasons) table.rows.push_back({reason, fmt::format("{}", trials)});
  if (!reasons.empty()) section.items.emplace_back(std::move(table));
  return section;
}

std::string spaced(std::string words) {
  std::ranges::replace(words, '_', ' ');
  return words;
}

// Text such as "max depth 38.7 mm" for "max_depth_m" and "38.7".
std::string in_words(std::string_view name, std::string_view number) {
  const auto unit = figure_unit(name);
  return fmt::format("{} {}{}", figure_title(name), number, unit == "–" ? "" : " " + unit);
}

StudySection trials_section(const CampaignResults& results) {
  constexpr std::size_t kMostRows = 500;
  StudySection section{.title = "Trial by trial", .folded = true};
  StudyTable table{.columns = {"trial", "kind", "set-up", "figures"}, .text_columns = 4};
  for (const auto& result : results.results) {
    if (table.rows.size() >= kMostRows) break;
    std::vector<std::string> setup, figures;
    for (const auto& [key, value] : result.setup)
      setup.push_back(in_words(key, fmt::format("{:.6g}", page_scale(key) * value)));
    for (const auto& q : result.quantities)
      figures.push_back(q.invalid.empty()
                            ? in_words(q.name, figure_number(page_scale(q.name) * q.value))
                            : fmt::format("{}: none, {}", figure_title(q.name), spaced(q.invalid)));
    table.rows.push_back({result.trial, result.usable ? result.kind : result.kind + " (not usable)",
                          fmt::format("{}", fmt::join(setup, "\n")),
                          fmt::format("{}", fmt::join(figures, "\n"))});
  }
  if (results.results.size() > kMostRows)
    table.note = fmt::format("The first {} of {} trials; all are in the JSON file.", kMostRows,
                             results.results.size());
  section.items.emplace_back(std::move(table));
  return section;
}

}  // namespace

std::vector<FindingGroup> all_findings(const CampaignResults& results) {
  std::vector<FindingGroup> groups;
  const auto add = [&](const Finding& finding) {
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const FindingGroup& group) {
      return group.first->kind == finding.kind && group.first->channel == finding.channel &&
             group.first->what == finding.what && group.first->line == finding.line &&
             group.first->file == finding.file;
    });
    if (same == groups.end())
      groups.push_back({&finding, 1});
    else
      ++same->trials;
  };
  for (const auto& finding : results.findings) add(finding);
  for (const auto& result : results.results)
    for (const auto& finding : result.findings) add(finding);
  return groups;
}

std::vector<RuledOut> all_ruled_out(const CampaignResults& results) {
  std::vector<RuledOut> reasons;
  for (const auto& result : results.results)
    for (const auto& reason : result.ruled_out) {
      const auto known = std::find_if(reasons.begin(), reasons.end(),
                                      [&](const RuledOut& one) { return one.reason == reason; });
      if (known == reasons.end())
        reasons.push_back({reason, 1});
      else
        ++known->trials;
    }
  return reasons;
}

CampaignReport report_on(const CampaignResults& results) {
  CampaignReport report;
  const auto findings = all_findings(results);
  const auto usable = static_cast<std::size_t>(std::count_if(results.results.begin(), results.results.end(),
                                                             [](const TrialResult& r) { return r.usable; }));
  report.json = to_json(results);
  report.json["usable_trials"] = usable;
  auto& study = report.study;
  study.title = results.campaign;
  study.facts = {{"plant", std::string(name_of(results.plant))},
                 {"trials", fmt::format("{} of {}", usable, results.results.size())}};
  if (results.parts > 1)
    study.warnings.push_back(
        fmt::format("This is part {} of {} of the campaign; merge the parts for its conclusions.",
                    results.part, results.parts));
  if (usable < results.results.size())
    study.warnings.push_back(fmt::format("{} of {} trials cannot be used; see Recordings.",
                                         results.results.size() - usable, results.results.size()));
  auto pooled = Json::object(), by_setup = Json::object(), conclusions = Json::object();
  for (const auto* analysis : all_analyses()) {
    const auto trials = usable_results(
        results, [&](const TrialResult& result) { return analysis->takes(results.plant, kind_of(result)); });
    if (trials.empty()) continue;
    auto told = analysis->conclude(trials);
    if (!told.json.empty()) conclusions[std::string(analysis->name())] = std::move(told.json);
    if (told.answer.empty() && !told.lines.empty()) told.answer = told.lines.front();
    if (!told.answer.empty()) study.verdict += (study.verdict.empty() ? "" : " ") + told.answer;
    std::move(told.lines.begin(), told.lines.end(), std::back_inserter(report.lines));
    std::move(told.sections.begin(), told.sections.end(), std::back_inserter(study.sections));
    std::move(told.tables.begin(), told.tables.end(), std::back_inserter(report.tables));
  }
  for (const auto kind : EnumNames<TrialKind>::value) {
    const auto trials =
        usable_results(results, [&](const TrialResult& result) { return result.kind == kind; });
    const auto quantities = pool_quantities(trials);
    if (quantities.empty()) continue;
    pooled[std::string(kind)] = pooled_json(quantities);
    by_setup[std::string(kind)] = pooled_by_setup(trials);
    study.sections.push_back({.title = fmt::format("All figures of trials of kind {}", kind),
                              .items = {pooled_table(quantities)},
                              .folded = true});
  }
  report.json["pooled"] = std::move(pooled);
  report.json["pooled_by_setup"] = std::move(by_setup);
  report.json["conclusions"] = std::move(conclusions);
  if (auto ruled_out = ruled_out_section(all_ruled_out(results)); !ruled_out.items.empty())
    study.sections.push_back(std::move(ruled_out));
  study.sections.push_back(findings_section(findings));
  study.sections.push_back(trials_section(results));
  return report;
}

}  // namespace sandhopper
