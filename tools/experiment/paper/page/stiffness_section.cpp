#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "tools/experiment/paper/page/series.hpp"
#include "tools/experiment/paper/reference_cases.hpp"
#include "tools/experiment/paper/report.hpp"
#include "tools/experiment/statistics.hpp"

namespace sandhopper::paper {
namespace {

constexpr std::array<const char*, kTreatments> kNames{"quasi-static, OLS", "observer, OLS",
                                                      "observer, weighted"};
constexpr std::array<const char*, kTreatments> kTreatmentColors{"orange", "purple", "blue"};

// k / k_GT of one cell for each seed that has it.
std::vector<double> ratios(const CaseResult& result, std::size_t treatment, std::size_t cell) {
  std::vector<double> by_seed;
  for (const auto& seed : result.ratio)
    if (std::isfinite(seed[cell][treatment])) by_seed.push_back(seed[cell][treatment]);
  return by_seed;
}

// One series per treatment. `place` gives the position of a value, `values` the value for each seed.
struct Bars {
  std::vector<std::size_t> items;
  std::function<double(std::size_t item, std::size_t treatment)> place;
  std::function<std::vector<double>(std::size_t item, std::size_t treatment)> values;
};

std::vector<StudySeries> treatment_series(const Bars& bars, StudySeries::Mark mark) {
  std::vector<StudySeries> all;
  for (std::size_t t = 0; t < kTreatments; ++t) {
    auto series = curve(kNames[t], kTreatmentColors[t], Style::bars);
    series.mark = mark;
    for (const std::size_t item : bars.items) {
      const auto found = bars.values(item, t);
      add(series, bars.place(item, t), mean(found), standard_deviation(found));
    }
    all.push_back(std::move(series));
  }
  return all;
}

// Position of a treatment within one category.
double beside(std::size_t item, std::size_t treatment) {
  return static_cast<double>(item) + 0.16 * (static_cast<double>(treatment) - 1.0);
}

// Axis of the cells in which the other property has the value `fixed`.
struct CellAxis {
  double HopCell::*axis;
  double HopCell::*other;
  double fixed;
  double scale;  // of the axis
  std::string x_label, title;
};

StudyFigure over_axis(const CaseResult& result, const CellAxis& a) {
  std::vector<std::size_t> cells;
  for (std::size_t i = 0; i < hop_cells().size(); ++i)
    if (hop_cells()[i].*a.other == a.fixed) cells.push_back(i);
  const auto at = [&a](std::size_t cell) { return a.scale * hop_cells()[cell].*a.axis; };
  auto truth = curve("⟦k_GT⟧", "grey", Style::dashed);
  add(truth, at(cells.front()), 1.0);
  add(truth, at(cells.back()), 1.0);
  StudyFigure figure{.title = a.title, .x_label = a.x_label, .y_label = "⟦k / k_GT⟧"};
  figure.series = treatment_series({cells, [&](std::size_t cell, std::size_t) { return at(cell); },
                                    [&](std::size_t cell, std::size_t t) { return ratios(result, t, cell); }},
                                   StudySeries::Mark::line_and_points);
  figure.series.push_back(std::move(truth));
  return figure;
}

std::vector<StudyFigure> axis_figures(const CaseResult& result) {
  std::vector<StudyFigure> figures;
  for (const double k : {250.0, 375.0, 500.0})
    figures.push_back(
        over_axis(result, {&HopCell::touchdown_speed_mps, &HopCell::compression_stiffness_N_per_m, k, 1.0,
                           "touchdown speed, m/s", fmt::format("Over touchdown speed, {:.0f} N/m", k)}));
  for (const double v : {0.2, 0.7, 1.2})
    figures.push_back(over_axis(
        result, {&HopCell::compression_stiffness_N_per_m, &HopCell::touchdown_speed_mps, v, 1.0,
                 "compression stiffness, N/m", fmt::format("Over compression stiffness, {:.1f} m/s", v)}));
  return figures;
}

std::vector<std::size_t> counted(std::size_t n) {
  std::vector<std::size_t> items(n);
  std::iota(items.begin(), items.end(), 0);
  return items;
}

StudyFigure all_cells(const CaseResult& result) {
  const auto values = [&](std::size_t cell, std::size_t t) { return ratios(result, t, cell); };
  StudyFigure figure{
      .title = "Every cell",
      .x_label = "touchdown speed, m/s / compression stiffness, N/m",
      .y_label = "⟦k / k_GT⟧",
      .series = treatment_series({counted(hop_cells().size()), beside, values}, StudySeries::Mark::points),
      .note = "Case A. 1 is the bed's own stiffness.",
      .wide = true};
  for (const auto& cell : hop_cells())
    figure.categories.push_back(
        fmt::format("{:g}/{:g}", cell.touchdown_speed_mps, cell.compression_stiffness_N_per_m));
  return figure;
}

StudyFigure by_window(const TreatmentStudy& study) {
  const auto errors = [&](std::size_t i, std::size_t t) {
    std::vector<double> by_seed;
    for (const auto& seed : study.cases[i].error_by_seed) by_seed.push_back(seed[t]);
    return by_seed;
  };
  StudyFigure figure{
      .title = "Mean error by sample window",
      .x_label = "case",
      .y_label = "mean ⟦|k / k_GT - 1|⟧",
      .series = treatment_series({counted(study.cases.size()), beside, errors}, StudySeries::Mark::points),
      .note = "Cases as in the table above. Bars: standard deviation over seeds."};
  for (const auto& one : study.cases) figure.categories.emplace_back(one.definition.name);
  return figure;
}

std::string window_text(const TreatmentCase& definition) {
  std::string text;
  switch (definition.window) {
    case SampleWindow::penetrating:
      text = "contact to greatest depth, faster than the threshold";
      break;
    case SampleWindow::new_depth:
      text = "new depths only";
      break;
    case SampleWindow::to_max_depth:
      text = "contact to greatest depth";
      break;
    case SampleWindow::whole_stance:
      text = "whole stance, with unloading";
      break;
    case SampleWindow::compression:
      text = "compression";
      break;
  }
  text += definition.free_intercept ? ", with intercept" : ", through the origin";
  return definition.true_state ? text + "; true force and state" : text;
}

StudyTable cases_table(const TreatmentStudy& study) {
  StudyTable table{
      .title = "Mean ⟦|k / k_GT - 1|⟧ over the cells",
      .columns = {"case", "samples", "quasi-static, OLS", "observer, OLS", "observer, weighted",
                  "observer nearer than quasi-static, seeds", "weighted nearer than OLS, seeds"},
      .text_columns = 2,
      .note = fmt::format(
          "Error of the stiffness as a share of ⟦k_GT⟧, mean over the cells of speed and leg stiffness. "
          "⟦k_GT⟧: slow intrusion into the bed's law, {:.0f} N/m with intercept, {:.0f} N/m "
          "through the origin. Seeds: repetitions in which the first of the two is nearer.",
          study.truth.free_intercept_N_per_m, study.truth.through_origin_N_per_m),
      .whole = true};
  for (const auto& one : study.cases) {
    const auto error = one.mean_error();
    const auto ordered = [&](Treatment worse, Treatment better) {
      return fmt::format("{} of {}", one.seeds_in_order(worse, better), one.error_by_seed.size());
    };
    table.rows.push_back({std::string(one.definition.name), window_text(one.definition),
                          fmt::format("{:.3f}", error[0]), fmt::format("{:.3f}", error[1]),
                          fmt::format("{:.3f}", error[2]),
                          ordered(Treatment::quasi_static_ols, Treatment::observer_ols),
                          ordered(Treatment::observer_ols, Treatment::observer_wls)});
  }
  return table;
}

StudyTable cells_table(const CaseResult& result) {
  StudyTable table{
      .title =
          "⟦k / k_GT⟧ by cell, case A: mean and standard deviation over seeds of the mean of five trials",
      .columns = {"touchdown speed, m/s", "compression stiffness, N/m", "quasi-static, OLS", "observer, OLS",
                  "observer, weighted"},
      .text_columns = 0,
      .whole = true};
  for (std::size_t cell = 0; cell < hop_cells().size(); ++cell) {
    std::vector<std::string> row{fmt::format("{:.2f}", hop_cells()[cell].touchdown_speed_mps),
                                 fmt::format("{:.0f}", hop_cells()[cell].compression_stiffness_N_per_m)};
    for (std::size_t t = 0; t < kTreatments; ++t) {
      const auto found = ratios(result, t, cell);
      row.push_back(found.size() > 1 ? fmt::format("{:.2f} ± {:.2f}", mean(found), standard_deviation(found))
                                     : fmt::format("{:.2f}", mean(found)));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

StudyTable conditions_table(const ProgrammeResults& r) {
  StudyTable table{
      .title = "Other conditions: mean ⟦|k / k_GT - 1|⟧",
      .columns = {"condition", "quasi-static, case A", "observer, case A", "observer weighted, case A",
                  "weighted nearer, seeds of case A", "quasi-static, case B", "observer, case B",
                  "observer weighted, case B", "without liftoff"},
      .note =
          "One figure changed at a time; ⟦k_GT⟧ is that of the changed bed. Cells without a liftoff are left "
          "out. Green: weights help in case A.",
      .whole = true};
  for (const auto& c : r.conditions) {
    const auto& [qs_a, mo_a, wls_a] = c.penetrating;
    const auto& [qs_b, mo_b, wls_b] = c.to_max_depth;
    table.rows.push_back({c.name, fmt::format("{:.3f}", qs_a), fmt::format("{:.3f}", mo_a),
                          fmt::format("{:.3f}", wls_a),
                          fmt::format("{} of {}", c.seeds_weighted_better, c.seeds),
                          fmt::format("{:.3f}", qs_b), fmt::format("{:.3f}", mo_b),
                          fmt::format("{:.3f}", wls_b), fmt::format("{} of {}", c.incomplete, c.strides)});
    table.row_marks.push_back(wls_a < mo_a ? "good" : "bad");
  }
  return table;
}

// Table that compares the results with those of another program with the same definitions.
StudyTable reference_table(const ProgrammeResults& r) {
  StudyTable table{
      .title = "Beside an independent simulation of the same definitions",
      .columns = {"case", "treatment", "here", "here, ages ignored", "there", "band, ±", "here inside",
                  "ages ignored, inside"},
      .text_columns = 2,
      .note =
          "Mean ⟦|k / k_GT - 1|⟧ here and in the other simulation (there), which gives its band. Here: every "
          "sample counts at the instant of its measurement. Ages ignored: the filter uses a height "
          "reading in the cycle that receives it, 2 ms and more late, and pairs a force with the "
          "depth of its row, which is one cycle younger. Case T uses the true force and state. "
          "Edge: green, inside the band here; yellow, only with ages ignored; red, neither.",
      .whole = true};
  for (const auto& expected : kReferenceCases)
    for (std::size_t i = 0; i < r.treatments.cases.size(); ++i) {
      if (r.treatments.cases[i].definition.name != expected.name) continue;
      const auto here = r.treatments.cases[i].mean_error();
      const auto ignored = r.without_ages.cases[i].mean_error();
      for (std::size_t t = 0; t < kTreatments; ++t) {
        const auto inside = [&](double value) {
          return std::abs(value - expected.error[t]) <= expected.band[t];
        };
        table.rows.push_back({std::string(expected.name), kNames[t], fmt::format("{:.3f}", here[t]),
                              fmt::format("{:.3f}", ignored[t]), fmt::format("{:.3f}", expected.error[t]),
                              fmt::format("{:.3f}", expected.band[t]), inside(here[t]) ? "yes" : "no",
                              inside(ignored[t]) ? "yes" : "no"});
        table.row_marks.push_back(inside(here[t]) ? "good" : inside(ignored[t]) ? "partly" : "bad");
      }
    }
  return table;
}

}  // namespace

StudySection stiffness_section(const ProgrammeResults& r) {
  const auto& a = r.treatments.cases.front();
  StudySection section{.title = "Stiffness"};
  section.items = {
      std::string(
          "Three treatments of the same hops: quasi-static force with ordinary least squares (OLS), the "
          "momentum observer's force with OLS, and the same with samples weighted by the foot's "
          "acceleration."),
      cases_table(r.treatments), by_window(r.treatments),
      std::string(
          "Case A by cell: each point is the mean of five trials, bars are standard deviations over seeds. "
          "A ratio of 1 is the bed's own stiffness.")};
  for (auto& figure : axis_figures(a)) section.items.emplace_back(std::move(figure));
  section.items.emplace_back(all_cells(a));
  section.items.emplace_back(cells_table(a));
  if (!r.conditions.empty()) section.items.emplace_back(conditions_table(r));
  section.items.emplace_back(reference_table(r));
  return section;
}

}  // namespace sandhopper::paper
