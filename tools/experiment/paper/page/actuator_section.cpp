#include <fmt/format.h>

#include <array>
#include <cmath>

#include "terrain/bed.hpp"
#include "tools/experiment/paper/page/series.hpp"
#include "tools/experiment/paper/report.hpp"
#include "tools/experiment/statistics.hpp"

namespace sandhopper::paper {
namespace {

constexpr std::array kColors{"blue", "green", "sand", "orange", "purple"};

// First trial of the speed closest to `speed_mps`.
const ActuatorRun& run_near(const ProgrammeResults& r, double speed_mps) {
  const auto nearer = [speed_mps](const ActuatorRun& a, const ActuatorRun& b) {
    return std::abs(a.speed_mps - speed_mps) < std::abs(b.speed_mps - speed_mps);
  };
  return *std::min_element(r.actuator.begin(), r.actuator.end(), nearer);
}

StudyFigure curves(const ProgrammeResults& r, bool residual) {
  StudyFigure figure{.title = residual ? "Residual of the map" : "Force against depth by speed",
                     .x_label = "depth, mm",
                     .y_label = residual ? "force less map, N" : "force, N",
                     .note = residual ? "Measured force less the map's, for five of the strokes."
                                      : "Five of the strokes as measured, and the map at their speeds."};
  std::size_t color = 0;
  for (const double wanted_mps : {0.022, 0.3, 0.55, 0.8, 1.1}) {
    const auto& run = run_near(r, wanted_mps);
    const auto label = fmt::format("{:.3f} m/s", run.speed_mps);
    auto measured = curve(label, kColors[color]);
    auto map = curve(label + ", map", kColors[color++], Style::dashed);
    for (const auto& [z, f] : run.samples) {
      const double expected_N = r.map.force_N(z, run.speed_mps);
      add(measured, 1e3 * z, residual ? f - expected_N : f);
      add(map, 1e3 * z, expected_N);
    }
    figure.series.push_back(std::move(measured));
    if (!residual) figure.series.push_back(std::move(map));
  }
  return figure;
}

StudyFigure slopes(const ProgrammeResults& r) {
  auto measured = curve("slope of each stroke", "blue", Style::points);
  for (const auto& run : r.actuator) {
    std::vector<double> z, f;
    for (const auto& sample : run.samples) {
      z.push_back(sample.depth_m);
      f.push_back(sample.force_N);
    }
    add(measured, run.speed_mps, fit_line(z, f).slope);
  }
  const auto level = [&r](const char* label, const char* color, double k) {
    auto line = curve(label, color, Style::dashed);
    add(line, 0.0, k);
    add(line, r.actuator.back().speed_mps, k);
    return line;
  };
  return {.title = "Stiffness of each stroke",
          .x_label = "speed, m/s",
          .y_label = "slope with intercept, N/m",
          .series = {measured, level("⟦k_GT⟧, slow runs", "orange", r.stiffness.slow_free_intercept),
                     level("bed", "grey", r.stiffness.bed)},
          .marks = {{r.inertial_speed_mps, "⟦sqrt(2 d g)⟧"}},
          .note = "Drag lifts the shallow end of the fast strokes' curves: their slope is lower."};
}

StudyFigure mass_profile(const ProgrammeResults& r, bool gradient) {
  const Bed bed(r.setup.world.terrain, r.setup.world.robot.leg.foot_radius_m);
  auto truth = curve("bed", "text", Style::dashed);
  auto map = curve(gradient ? "coefficient of v² in the map" : "integrated map", "blue");
  auto lag = curve("amplifier's lag left in", "orange");
  for (int i = 0; i <= 80; ++i) {
    const double z = 0.0005 * i;
    const auto value = [&](const ForceMap& m) {
      return gradient ? m.mass_gradient_kg_per_m(z) : 1e3 * m.added_mass_kg(z);
    };
    add(truth, 1e3 * z, gradient ? bed.added_mass_gradient_kg_per_m(z) : 1e3 * bed.added_mass_kg(z));
    add(map, 1e3 * z, value(r.map));
    add(lag, 1e3 * z, value(r.map_with_lag));
  }
  return {.title = gradient ? "Added-mass gradient" : "Added mass",
          .x_label = "depth, mm",
          .y_label = gradient ? "gradient of ⟦m_a⟧, kg/m" : "added mass ⟦m_a⟧, g",
          .series = {map, lag, truth},
          .note = gradient ? "From the map, with and without the correction for the amplifier's lag, beside "
                             "the simulated bed's own law."
                           : "The gradient integrated over depth."};
}

StudyTable definitions(const ProgrammeResults& r) {
  const auto& k = r.stiffness;
  StudyTable table{.title = "⟦k_GT⟧ by definition",
                   .columns = {"definition", "stiffness, N/m", "against the bed, %"},
                   .note =
                       "The stiffness of the same bed by eight definitions. Those without noise are the "
                       "truth that the treatments below are compared with."};
  const auto row = [&](const char* name, double value) {
    table.rows.push_back(
        {name, fmt::format("{:.0f}", value), fmt::format("{:+.1f}", 100.0 * (value / k.bed - 1.0))});
  };
  row("bed as given", k.bed);
  row("runs below ⟦sqrt(2 d g)⟧, line with intercept", k.slow_free_intercept);
  row("runs below ⟦sqrt(2 d g)⟧, line through the origin", k.slow_through_origin);
  row("coefficient of ⟦z⟧ in the map", k.map_coefficient);
  row("all runs, line with intercept", k.all_runs_free_intercept);
  row("runs from 1 m/s on, line with intercept", k.fastest_free_intercept);
  row("bed's law without noise, intercept (truth of the treatments)",
      r.treatments.truth.free_intercept_N_per_m);
  row("bed's law without noise, through the origin", r.treatments.truth.through_origin_N_per_m);
  return table;
}

}  // namespace

StudySection actuator_section(const ProgrammeResults& r) {
  const auto& [a, b, c] = r.map.drag_coefficient;
  StudySection section{.title = "Actuator"};
  section.items = {
      fmt::format(
          "{} strokes of {:.0f} mm at {} constant speeds, {:.3f} to {:.2f} m/s; each in its own bed, force "
          "through the load cell's amplifier and converter, paired with the depth one amplifier time "
          "constant earlier.",
          r.actuator.size(), 1e3 * r.setup.actuator.stroke_m, r.setup.actuator.speeds,
          r.actuator.front().speed_mps, r.actuator.back().speed_mps),
      fmt::format("Depth-speed map by ordinary least squares over {} samples: ⟦F = {:.2f} + {:.0f} z + "
                  "({:.2f} {} {:.0f} z {} {:.0f} z^2) v^2⟧, with ⟦F⟧ in N, ⟦z⟧ in m and ⟦v⟧ in m/s. "
                  "⟦R^2⟧ is {:.4f}, the rms of the residuals {:.2f} N.",
                  r.map.samples, r.map.intercept_N, r.map.stiffness_N_per_m, a, b < 0.0 ? "-" : "+",
                  std::abs(b), c < 0.0 ? "-" : "+", std::abs(c), r.map.r_squared, r.map.rms_N),
      definitions(r),
      curves(r, false),
      curves(r, true),
      slopes(r),
      mass_profile(r, true),
      mass_profile(r, false)};
  return section;
}

}  // namespace sandhopper::paper
