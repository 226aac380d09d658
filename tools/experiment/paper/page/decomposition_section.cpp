#include <fmt/format.h>

#include "tools/experiment/paper/page/series.hpp"
#include "tools/experiment/paper/report.hpp"
#include "tools/experiment/paper/summaries.hpp"

namespace sandhopper::paper {
namespace {

using Value = double (*)(const PenetratingSample&);

// Series over time since contact. The plateau between the two phases of penetration is a gap.
StudySeries over_time(const std::vector<PenetratingSample>& samples, std::string label, std::string color,
                      Value value, Style style = Style::line) {
  constexpr double kGap_s = 0.003;
  auto series = curve(std::move(label), std::move(color), style);
  double last_s = 0.0;
  for (const auto& s : samples) {
    if (s.time_s - last_s > kGap_s) lift_pen(series, 1e3 * s.time_s);
    last_s = s.time_s;
    add(series, 1e3 * s.time_s, value(s));
  }
  return series;
}

StudyFigure descriptions(const std::vector<PenetratingSample>& samples) {
  using Sample = PenetratingSample;
  return {.title = "Force of one stride and its descriptions",
          .x_label = "time since contact, ms",
          .y_label = "force, N",
          .series = {over_time(samples, "true force", "text", [](const Sample& s) { return s.force_N; }),
                     over_time(
                         samples, "line of this trial", "grey", [](const Sample& s) { return s.line_N; },
                         Style::dashed),
                     over_time(samples, "depth-speed map", "orange", [](const Sample& s) { return s.map_N; }),
                     over_time(samples, "map and added mass", "blue",
                               [](const Sample& s) { return s.map_N + s.inertia_N; })},
          .note = "Samples at new depths only: the gap is the plateau."};
}

StudyFigure remainder(const std::vector<PenetratingSample>& samples) {
  using Sample = PenetratingSample;
  return {.title = "Residual of the map, and the added mass's force",
          .x_label = "time since contact, ms",
          .y_label = "force, N",
          .series = {over_time(samples, "force less map", "orange",
                               [](const Sample& s) { return s.force_N - s.map_N; }),
                     over_time(samples, "⟦-m_a z''⟧", "blue", [](const Sample& s) { return s.inertia_N; })},
          .note = "The added mass explains what the map leaves if the two lines agree."};
}

StudyFigure rms_by_speed(const std::vector<SpeedDecomposition>& rows) {
  auto line = curve("line of the trial", "grey");
  auto map = curve("map", "orange");
  auto both = curve("map and added mass", "blue");
  for (auto* series : {&line, &map, &both}) series->mark = StudySeries::Mark::line_and_points;
  for (const auto& row : rows) {
    add(line, row.speed_mps, row.line_N);
    add(map, row.speed_mps, row.map_N);
    add(both, row.speed_mps, row.inertial_N);
  }
  return {.title = "Rms of what remains by touchdown speed",
          .x_label = "touchdown speed, m/s",
          .y_label = "rms, N",
          .series = {line, map, both},
          .note = "By the true force and motion, mean over the trials of a speed."};
}

void add_rows(StudyTable& table, const std::string& source, const std::vector<SpeedDecomposition>& rows) {
  for (const auto& d : rows)
    table.rows.push_back({source, fmt::format("{:.2f}", d.speed_mps), fmt::format("{:.2f}", d.line_N),
                          fmt::format("{:.2f}", d.map_N), fmt::format("{:.2f}", d.inertial_N),
                          fmt::format("{:.0f}", d.drop_percent()), fmt::format("{:.2f}", d.correlation)});
}

StudyTable rms_table(const ProgrammeResults& r) {
  StudyTable table{
      .title = "Rms of what remains, mean over trials",
      .columns = {"force and motion from", "speed, m/s", "line, N", "map, N", "map and added mass, N",
                  "falls by, %", "correlation"},
      .note =
          "Rms of the force that each description leaves. Falls by: from the map to the map with "
          "added mass. Correlation: between ⟦-m_a z''⟧ and what the map leaves.",
      .whole = true};
  add_rows(table, "truth", decomposition_by_speed(r, &HopResult::truth));
  add_rows(table, "load cell, true motion", decomposition_by_speed(r, &HopResult::instruments));
  add_rows(table, "robot's own estimates", decomposition_by_speed(r, &HopResult::robot));
  return table;
}

}  // namespace

StudySection decomposition_section(const ProgrammeResults& r) {
  const auto samples = penetrating_samples(r.example, r.map, ForceSource::truth);
  StudySection section{.title = "Added mass"};
  section.items = {
      std::string("Three descriptions of the force in hops, at new depths: a straight line fitted to the "
                  "trial itself, the map of the actuator's strokes, and the map with the inertia of the "
                  "added mass that is "
                  "integrated from it. No number of the map or of the added mass is fitted to a hop."),
      rms_table(r), descriptions(samples), remainder(samples),
      rms_by_speed(decomposition_by_speed(r, &HopResult::truth))};
  return section;
}

}  // namespace sandhopper::paper
