#include <fmt/format.h>

#include "tools/experiment/paper/page/series.hpp"
#include "tools/experiment/paper/report.hpp"
#include "tools/experiment/paper/summaries.hpp"

namespace sandhopper::paper {
namespace {

StudySeries by_speed(const std::vector<SpeedErrors>& rows, std::string label, std::string color,
                     SquareSum EstimationErrors::*value, double scale = 1.0) {
  auto series = curve(std::move(label), std::move(color));
  series.mark = StudySeries::Mark::line_and_points;
  for (const auto& row : rows) add(series, row.speed_mps, scale * (row.errors.*value).rms());
  return series;
}

StudyTable errors_table(const std::vector<SpeedErrors>& rows) {
  StudyTable table{
      .title = "Rms errors in stance",
      .columns = {"touchdown speed, m/s", "quasi-static, N", "observer, N", "load cell, N",
                  "quasi-static to load cell, N", "observer to load cell, N",
                  "foot depth to motion capture, mm", "about the trial's mean, mm", "foot velocity, m/s",
                  "body velocity, m/s"},
      .text_columns = 0,
      .note =
          "Forces against the true force unless said otherwise; velocities against the truth. About the "
          "trial's mean: without the offset of the height sensor, which is constant in a trial."};
  for (const auto& [speed_mps, e] : rows)
    table.rows.push_back(
        {fmt::format("{:.2f}", speed_mps), fmt::format("{:.2f}", e.quasi_static_N.rms()),
         fmt::format("{:.2f}", e.observer_N.rms()), fmt::format("{:.2f}", e.load_cell_N.rms()),
         fmt::format("{:.2f}", e.quasi_static_to_cell_N.rms()),
         fmt::format("{:.2f}", e.observer_to_cell_N.rms()), fmt::format("{:.2f}", 1e3 * e.foot_depth_m.rms()),
         fmt::format("{:.2f}", 1e3 * e.depth_about_trial_mean_m.rms()),
         fmt::format("{:.4f}", e.foot_velocity_mps.rms()), fmt::format("{:.4f}", e.body_velocity_mps.rms())});
  return table;
}

}  // namespace

StudySection estimation_section(const ProgrammeResults& r) {
  const auto rows = errors_by_speed(r);
  StudySection section{.title = "State and force"};
  section.items = {
      errors_table(rows),
      StudyFigure{.title = "Force error",
                  .x_label = "touchdown speed, m/s",
                  .y_label = "rms, N",
                  .series = {by_speed(rows, "quasi-static", "orange", &EstimationErrors::quasi_static_N),
                             by_speed(rows, "momentum observer", "blue", &EstimationErrors::observer_N),
                             by_speed(rows, "load cell", "green", &EstimationErrors::load_cell_N)}},
      StudyFigure{.title = "Depth error",
                  .x_label = "touchdown speed, m/s",
                  .y_label = "rms, mm",
                  .series = {by_speed(rows, "raw time of flight", "grey", &EstimationErrors::tof_m, 1e3),
                             by_speed(rows, "filter", "blue", &EstimationErrors::foot_depth_m, 1e3),
                             by_speed(rows, "filter, about the trial's mean", "orange",
                                      &EstimationErrors::depth_about_trial_mean_m, 1e3)}}};
  return section;
}

}  // namespace sandhopper::paper
