#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "tools/experiment/paper/page/series.hpp"
#include "tools/experiment/paper/report.hpp"

namespace sandhopper::paper {
namespace {

constexpr double kGap = std::numeric_limits<double>::quiet_NaN();
using RowValue = std::function<double(const HopRow&)>;

// A channel over time in ms; rows without a value are left out.
StudySeries over_time(const HopTrial& trial, std::string label, std::string color, Style style,
                      const RowValue& value) {
  auto series = curve(std::move(label), std::move(color), style);
  for (const auto& row : trial.rows)
    if (const double y = value(row); std::isfinite(y)) add(series, 1e3 * row.time_s, y);
  return series;
}

std::vector<std::pair<double, std::string>> events(const HopTrial& trial) {
  const auto at = stance_rows(trial);
  std::vector<std::pair<double, std::string>> marks;
  const auto mark = [&](std::size_t row, const char* name) {
    if (row < trial.rows.size()) marks.emplace_back(1e3 * trial.rows[row].time_s, name);
  };
  mark(at.contact, "TD");
  mark(at.change, "CE");
  mark(at.liftoff, "LO");
  return marks;
}

double mm(double metres) { return 1e3 * metres; }

// A figure over time that shows the stride's events.
StudyFigure panel(const HopTrial& trial, std::string title, std::string y_label,
                  std::vector<StudySeries> series) {
  return {.title = std::move(title),
          .x_label = "time since release, ms",
          .y_label = std::move(y_label),
          .series = std::move(series),
          .marks = events(trial)};
}

StudyFigure leg_length(const HopTrial& t) {
  return panel(t, "Leg length", "leg length, mm",
               {over_time(t, "from encoders", "blue", Style::line,
                          [](const HopRow& r) { return mm(r.estimate.leg_length_m); })});
}

StudyFigure body_height(const HopTrial& t) {
  return panel(t, "Body height", "height, mm",
               {over_time(t, "time of flight", "grey", Style::points,
                          [](const HopRow& r) { return r.tof.fresh ? mm(r.tof.height_m) : kGap; }),
                over_time(t, "motion capture", "text", Style::dashed,
                          [](const HopRow& r) { return mm(r.truth.mocap_body_z_m); }),
                over_time(t, "estimate", "blue", Style::line,
                          [](const HopRow& r) { return mm(r.estimate.body_z_m); })});
}

StudyFigure foot_height(const HopTrial& t) {
  return panel(t, "Foot height", "height over the surface, mm",
               {over_time(t, "motion capture", "text", Style::dashed,
                          [](const HopRow& r) { return mm(r.truth.mocap_foot_z_m); }),
                over_time(t, "estimate", "orange", Style::line,
                          [](const HopRow& r) { return mm(r.estimate.foot_z_m); })});
}

StudyFigure velocities(const HopTrial& t) {
  return panel(t, "Velocities", "velocity, m/s",
               {over_time(t, "body, true", "text", Style::dashed,
                          [](const HopRow& r) { return r.truth.body_velocity_mps; }),
                over_time(t, "foot, true", "grey", Style::dashed,
                          [](const HopRow& r) { return r.truth.foot_velocity_mps; }),
                over_time(t, "body", "blue", Style::line,
                          [](const HopRow& r) { return r.estimate.body_velocity_mps; }),
                over_time(t, "foot", "orange", Style::line,
                          [](const HopRow& r) { return r.estimate.foot_velocity_mps; })});
}

StudyFigure accelerations(const HopTrial& t) {
  return panel(
      t, "Accelerations", "acceleration, m/s²",
      {over_time(t, "body", "blue", Style::line, [](const HopRow& r) { return r.estimate.body_accel_mps2; }),
       over_time(t, "foot", "orange", Style::line,
                 [](const HopRow& r) { return r.estimate.foot_accel_mps2; })});
}

StudyFigure forces(const HopTrial& t) {
  return panel(t, "Force of the ground", "force, N",
               {over_time(t, "load cell", "green", Style::line,
                          [](const HopRow& r) { return r.estimate.load_cell_force_N; }),
                over_time(t, "quasi-static", "orange", Style::line,
                          [](const HopRow& r) { return r.estimate.quasi_static_force_N; }),
                over_time(t, "momentum observer", "blue", Style::line,
                          [](const HopRow& r) { return r.estimate.contact_force_N; })});
}

// The first 80 ms of contact, with each force at its own instant.
StudyFigure touchdown(const HopTrial& t) {
  auto truth = curve("true", "text", Style::dashed);
  auto cell = curve("load cell", "green");
  auto quasi_static = curve("quasi-static", "orange");
  auto observer = curve("momentum observer", "blue");
  const auto at = stance_rows(t);
  for (std::size_t i = at.contact - 10; i < std::min(at.contact + 80, t.rows.size()); ++i) {
    const auto ms = [&](std::size_t row) { return 1e3 * (t.rows[row].time_s - t.rows[at.contact].time_s); };
    const auto& row = t.rows[i];
    add(truth, ms(i), row.truth.contact_force_N);
    add(quasi_static, ms(i - 1), row.estimate.quasi_static_force_N);
    add(observer, ms(i - 1), row.estimate.contact_force_N);
    const double age_ms = 1e-6 * static_cast<double>(row.truth.time_ns - row.load_cell.time_ns);
    if (row.load_cell.fresh) add(cell, ms(i) - age_ms, row.estimate.load_cell_force_N);
  }
  return {.title = "Touchdown, zoomed",
          .x_label = "time since contact, ms",
          .y_label = "force, N",
          .series = {truth, cell, quasi_static, observer},
          .note = "The first 80 ms of contact; each force at the instant of its measurement."};
}

StudySeries over_depth(const HopTrial& trial, std::string label, std::string color, const RowValue& force) {
  auto series = curve(std::move(label), std::move(color));
  const auto at = stance_rows(trial);
  for (std::size_t i = at.contact; i < at.liftoff; ++i)
    add(series, mm(trial.rows[i].estimate.force_depth_m), force(trial.rows[i]));
  return series;
}

StudyFigure force_depth(const HopTrial& t) {
  return {.title = "Force against depth",
          .x_label = "estimated depth, mm",
          .y_label = "force, N",
          .series = {over_depth(t, "load cell", "green",
                                [](const HopRow& r) { return r.estimate.load_cell_force_N; }),
                     over_depth(t, "quasi-static", "orange",
                                [](const HopRow& r) { return r.estimate.quasi_static_force_N; }),
                     over_depth(t, "momentum observer", "blue",
                                [](const HopRow& r) { return r.estimate.contact_force_N; })},
          .note = "From the left: touchdown, plateau, second penetration, unloading."};
}

StudySeries after_contact(const HopTrial& trial, std::string label, std::string color) {
  auto series = curve(std::move(label), std::move(color));
  const auto at = stance_rows(trial);
  for (std::size_t i = at.contact; i < std::min(at.contact + 120, trial.rows.size()); ++i)
    add(series, 1e3 * (trial.rows[i].time_s - trial.rows[at.contact].time_s), trial.rows[i].mean_force_N);
  return series;
}

StudyFigure early_peak(const ProgrammeResults& r) {
  return {
      .title = "Early force peak: this bed and one a hundred times as stiff",
      .x_label = "time since contact, ms",
      .y_label = "true force, N",
      .series = {after_contact(r.quiet, "this bed", "blue"), after_contact(r.rigid, "stiff bed", "orange")},
      .note = "Without noise; mean over each millisecond."};
}

}  // namespace

StudySection stride_section(const ProgrammeResults& r) {
  const auto& t = r.example;
  StudySection section{.title = "Single stride"};
  section.items = {
      fmt::format("One trial of the hop set: touchdown at {:.1f} m/s, compression with {:.0f} N/m. TD: the "
                  "foot meets the bed; CE: compression ends, extension begins; LO: liftoff.",
                  t.cell.touchdown_speed_mps, t.cell.compression_stiffness_N_per_m),
      leg_length(t),
      body_height(t),
      foot_height(t),
      velocities(t),
      accelerations(t),
      forces(t),
      force_depth(t),
      touchdown(t),
      early_peak(r)};
  return section;
}

}  // namespace sandhopper::paper
