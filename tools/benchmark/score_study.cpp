#include "tools/benchmark/score_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sandhopper::benchmark {
namespace {

std::string percent(double share) { return fmt::format("{:.1f}", 100.0 * share); }

std::string shown(const Figure& f) {
  if (f.of == 0) return "–";
  const auto interval = wilson95(f.count, f.of);
  return fmt::format("{} ({}–{})", percent(f.value()), percent(interval.low), percent(interval.high));
}

std::string shown(const std::optional<double>& share) { return share ? percent(*share) : "–"; }

std::string at_least(double limit) { return "≥ " + percent(limit); }

std::string met_text(std::size_t of, bool met, const char* yes = "yes", const char* no = "no") {
  return of == 0 ? "–" : met ? yes : no;
}

std::string bound(const Figure& f, double limit) {
  return f.less_is_better ? "≤ " + percent(limit) : at_least(limit);
}

StudyTable figures_table(const std::vector<Column>& columns, const std::vector<Figure>& splits) {
  StudyTable table{.title = "Figures of the benchmark, % (95 % Wilson interval)", .columns = {"figure"}};
  for (const auto& column : columns) table.columns.push_back(column.name);
  for (const char* name : {"of", "must", "aim", "met"}) table.columns.push_back(name);
  for (std::size_t i = 0; i < columns.front().score.figures.size(); ++i) {
    const auto& own = columns.front().score.figures[i];
    std::vector<std::string> row{own.name};
    for (const auto& column : columns) row.push_back(shown(column.score.figures[i]));
    for (const auto& text : {fmt::format("{}", own.of), bound(own, own.must), bound(own, own.aim)})
      row.push_back(text);
    row.push_back(met_text(own.of, own.met()));
    table.rows.push_back(std::move(row));
  }
  for (const auto& split : splits) {
    std::vector<std::string> row{split.name, shown(split)};
    row.resize(1 + columns.size(), "–");
    row.insert(row.end(), {fmt::format("{}", split.of), bound(split, split.must), bound(split, split.aim),
                           met_text(split.of, split.met())});
    table.rows.push_back(std::move(row));
  }
  const auto& own = columns.front().score;
  std::vector<std::string> row{"localisation, F1 of the cells"};
  for (const auto& column : columns) row.push_back(shown(column.score.localisation.f1()));
  const auto& where = own.localisation;
  row.insert(row.end(), {fmt::format("{}", where.campaigns), at_least(Localisation::kMust),
                         at_least(Localisation::kAim), met_text(where.campaigns, where.met())});
  table.rows.push_back(std::move(row));
  table.note = fmt::format(
      "Typical size: {} to {} times the size in the generator's list. Mean class size of the right names "
      "there: {:.2f}. Hidden parameters that the diagnosis has under no such name or unit: {}; the "
      "intervals' "
      "figure leaves them out.",
      kTypicalFrom, kTypicalTo, own.mean_class_size, own.intervals_without_counterpart);
  return table;
}

StudyTable localisation_table(const Score& score) {
  StudyTable table{
      .title = "Localisation: cells that are reported, against those with a hidden effect",
      .columns = {"plant", "campaigns", "true positives", "false positives", "missed", "precision, %",
                  "recall, %", "F1, %"},
      .note =
          "A cell is one channel in one phase of the motion. A hidden effect is in it if it changes the cell "
          "by more than the sensor's noise in at least one trial. Only campaigns whose diagnosis says that "
          "physics is missing are counted."};
  const auto add = [&](const std::string& name, const Localisation& l) {
    std::vector<std::string> row{name};
    for (const auto count : {l.campaigns, l.true_positives, l.false_positives, l.missed})
      row.push_back(fmt::format("{}", count));
    for (const auto& share : {l.precision(), l.recall(), l.f1()}) row.push_back(shown(share));
    table.rows.push_back(std::move(row));
  };
  for (const auto& [plant, localisation] : score.localisation_by_plant) add(plant, localisation);
  add("all", score.localisation);
  return table;
}

StudyFigure reliability(const Score& score) {
  StudySeries seen{.label = "share right", .mark = StudySeries::Mark::points};
  for (const auto& bin : score.reliability) {
    if (!bin.count) continue;
    const auto interval = wilson95(bin.right, bin.count);
    seen.x.push_back(bin.probability_sum / static_cast<double>(bin.count));
    seen.y.push_back(static_cast<double>(bin.right) / static_cast<double>(bin.count));
    seen.low.push_back(interval.low);
    seen.high.push_back(interval.high);
  }
  StudySeries ideal{.label = "ideal",
                    .x = {0.0, 1.0},
                    .y = {0.0, 1.0},
                    .mark = StudySeries::Mark::line,
                    .color = "grey",
                    .dashed = true};
  return {.title = "Reliability of the stated probability",
          .x_label = "stated probability",
          .y_label = "share right",
          .series = {seen, ideal},
          .note = fmt::format("Expected calibration error {:.3f} over {} names.",
                              score.expected_calibration_error, score.names_claimed)};
}

StudyFigure ladder(const Score& score) {
  const auto series = [&](const char* label, const char* color, std::size_t LadderStep::*count) {
    StudySeries s{.label = label, .mark = StudySeries::Mark::line_and_points, .color = color};
    for (std::size_t i = 0; i < score.ladder.size(); ++i) {
      const auto& step = score.ladder[i];
      const auto interval = wilson95(step.*count, step.cases);
      s.x.push_back(static_cast<double>(i));
      s.y.push_back(step.cases ? static_cast<double>(step.*count) / static_cast<double>(step.cases)
                               : std::nan(""));
      s.low.push_back(interval.low);
      s.high.push_back(interval.high);
    }
    return s;
  };
  StudyFigure figure{.title = "One effect, by its size",
                     .x_label = "size relative to typical",
                     .y_label = "share of cases",
                     .series = {series("noticed", "green", &LadderStep::noticed),
                                series("right name or class", "blue", &LadderStep::right),
                                series("confident wrong name", "orange", &LadderStep::confident_wrong)}};
  for (const auto& step : score.ladder)
    figure.categories.push_back(fmt::format("{:.3g}–{:.3g} (n {})", step.from, step.to, step.cases));
  return figure;
}

StudyTable by_effect(const Score& score) {
  StudyTable table{.title = "What became of each effect, one hidden, all sizes",
                   .columns = {"hidden", "other names given", "cases", "right alone", "right in a class",
                               "unknown", "nothing missing", "too little data", "no answer"},
                   .text_columns = 2};
  for (const auto& [id, f] : score.by_effect) {
    std::string others;
    for (const auto& [name, count] : f.other_names)
      others += fmt::format("{}{}", others.empty() ? "" : "; ", name) +
                (count > 1 ? fmt::format(" ({})", count) : "");
    std::vector<std::string> row{id, others};
    for (const auto count :
         {f.cases, f.right_alone, f.right_in_class, f.unknown, f.nothing, f.too_little, f.no_answer})
      row.push_back(count ? fmt::format("{}", count) : "");
    table.rows.push_back(std::move(row));
  }
  return table;
}

StudyTable every_case(const Score& score) {
  StudyTable table{
      .title = "Every case",
      .columns = {"campaign", "plant", "kind", "hidden (size)", "said", "right", "visibility", "precision, %",
                  "recall, %"},
      .text_columns = 5,
      .note = "Precision and recall of the localisation: – if it is not scored, or no cell is reported."};
  for (const auto& j : score.cases) {
    std::string hidden;
    for (const auto& effect : j.truth->effects)
      hidden += fmt::format("{}{} ({:.2f})", hidden.empty() ? "" : ", ", effect.id, effect.size);
    table.rows.push_back({j.truth->name, j.truth->plant, j.truth->kind, hidden, j.said,
                          passed(j)           ? "yes"
                          : j.confident_wrong ? "NO, and sure"
                                              : "no",
                          fmt::format("{:.2f}", j.truth->visibility),
                          j.localisation ? shown(j.localisation->precision()) : "–",
                          j.localisation ? shown(j.localisation->recall()) : "–"});
  }
  return table;
}

std::string time_text(std::vector<double> seconds) {
  if (seconds.empty()) return "not noted";
  std::sort(seconds.begin(), seconds.end());
  return fmt::format("median {:.1f} s, 95th percentile {:.1f} s, longest {:.1f} s",
                     seconds[seconds.size() / 2], seconds[seconds.size() * 95 / 100], seconds.back());
}

}  // namespace

Study score_study(const std::vector<Column>& columns, const std::vector<Figure>& splits,
                  const std::vector<double>& seconds) {
  const auto& own = columns.front().score;
  Study study{.title = "hop diagnose on concealed campaigns"};
  const auto unanswered =
      std::count_if(own.cases.begin(), own.cases.end(), [](const Judged& j) { return !j.answered; });
  study.facts = {{"campaigns", fmt::format("{}", own.cases.size())},
                 {"without an answer", fmt::format("{}", unanswered)},
                 {"time", time_text(seconds)}};
  for (const auto& f : own.figures)
    if (f.of > 0 && !f.met())
      study.warnings.push_back(
          fmt::format("Missed: {}: {} %, must be {} %.", f.name, shown(f), bound(f, f.must)));
  if (own.localisation.campaigns > 0 && !own.localisation.met())
    study.warnings.push_back(fmt::format("Missed: localisation, F1: {} %, must be {} %.",
                                         shown(own.localisation.f1()), at_least(Localisation::kMust)));
  StudyTable plants{.title = "Right name or class at typical size, by plant",
                    .columns = {"plant", "right, %", "of"}};
  for (const auto& [plant, f] : own.right_by_plant)
    plants.rows.push_back({plant, shown(f), fmt::format("{}", f.of)});
  study.sections = {{.title = "Figures", .items = {figures_table(columns, splits)}},
                    {.title = "Certainty and size", .items = {reliability(own), ladder(own), plants}},
                    {.title = "Localisation", .items = {localisation_table(own)}},
                    {.title = "By effect", .items = {by_effect(own)}},
                    {.title = "Cases", .items = {every_case(own)}}};
  return study;
}

std::vector<std::string> score_text(const std::vector<Column>& columns, const std::vector<Figure>& splits,
                                    const std::vector<double>& seconds) {
  const auto& own = columns.front().score;
  std::vector<std::string> lines;
  auto figures = own.figures;
  figures.insert(figures.end(), splits.begin(), splits.end());
  for (const auto& f : figures)
    lines.push_back(fmt::format("{:<52} {:>20} % of {:<4} must {:<7} {}", f.name, shown(f), f.of,
                                bound(f, f.must), met_text(f.of, f.met(), "met", "MISSED")));
  lines.push_back(fmt::format("{:<52} {:>20.2f}", "mean class size of the right names", own.mean_class_size));
  const auto& where = own.localisation;
  lines.push_back(fmt::format("{:<52} {:>20} % of {:<4} must {:<7} {}", "localisation, F1 of the cells",
                              shown(where.f1()), where.campaigns, at_least(Localisation::kMust),
                              met_text(where.campaigns, where.met(), "met", "MISSED")));
  lines.push_back(fmt::format("{:<52} {:>20} %, {} %", "localisation, precision and recall",
                              shown(where.precision()), shown(where.recall())));
  lines.push_back(
      fmt::format("{:<52} {:>20.3f}", "expected calibration error", own.expected_calibration_error));
  lines.push_back(fmt::format("{:<52} {}", "time of a diagnosis", time_text(seconds)));
  for (std::size_t i = 1; i < columns.size(); ++i) {
    const auto& f = columns[i].score.figures;
    lines.push_back(fmt::format("{:<20} false alarms {} %, right {} %, confident wrong {} %", columns[i].name,
                                shown(f[0]), shown(f[1]), shown(f[2])));
  }
  return lines;
}

}  // namespace sandhopper::benchmark
