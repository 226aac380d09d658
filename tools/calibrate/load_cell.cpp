#include "tools/calibrate/load_cell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "drivers/adc/ads1115.hpp"
#include "terrain/trial_statistics.hpp"
#include "tools/calibrate/devices.hpp"
#include "tools/calibrate/line.hpp"

namespace sandhopper::calibrate {
namespace {

constexpr double kWander_N = 0.05;  // allowed drift within a recording, beyond noise

struct Weighed {
  std::vector<double> force_N;    // m g
  std::vector<double> reading_N;  // force by the present configuration
  std::vector<double> error_N;    // standard error of the reading
  std::vector<std::string> name;
};

// Only the kernel driver of an IIO converter knows its range.
void check_range(const WeighedPoint& point, const LoadCellConfig& config, std::vector<Refusal>& refusals) {
  if (config.is_iio()) return;
  const double full_V = ads1115_full_scale_V(config.range);
  const auto at_the_end = std::ranges::count_if(point.recording.load_cell, [&](const LoadCellSample& s) {
    return std::abs(load_cell_voltage_V(s.force_N, config)) > 0.995 * full_V;
  });
  if (at_the_end > 0)
    refusals.push_back(
        {"saturated",
         fmt::format("{}: {} of {} samples are at the end of the converter's {:.3f} V", point.recording.name,
                     at_the_end, point.recording.load_cell.size(), full_V),
         "choose a wider load_cell.range, a smaller gain of the amplifier, or lighter weights"});
}

Weighed weigh(const std::vector<WeighedPoint>& points, const LoadCellConfig& config, double gravity_mps2,
              std::vector<Refusal>& refusals) {
  Weighed out;
  for (const auto& point : points) {
    const auto before = refusals.size();
    const auto series = series_of(point.recording.load_cell, [](const auto& s) { return s.force_N; });
    check_range(point, config, refusals);
    const auto mean =
        still_mean(series, {.max_wander = kWander_N},
                   fmt::format("{} ({} kg), force in N", point.recording.name, point.mass_kg), refusals);
    if (refusals.size() != before) continue;
    out.force_N.push_back(point.mass_kg * gravity_mps2);
    out.reading_N.push_back(mean.value);
    out.error_N.push_back(mean.standard_error);
    out.name.push_back(fmt::format("{} kg", point.mass_kg));
  }
  return out;
}

// Largest difference between readings of the same weight.
struct Repeat {
  double difference_N = 0.0;
  double force_N = 0.0;
  bool any = false;
};
Repeat worst_repeat(const Weighed& w) {
  Repeat out;
  for (std::size_t i = 0; i < w.force_N.size(); ++i)
    for (std::size_t k = i + 1; k < w.force_N.size(); ++k) {
      if (w.force_N[i] != w.force_N[k]) continue;
      const double difference = std::abs(w.reading_N[i] - w.reading_N[k]);
      if (!out.any || difference > out.difference_N) out = {difference, w.force_N[i], true};
    }
  return out;
}

// Allowed residual: 5 standard errors of the means, and a share of the largest force for the cell itself.
double allowed_N(const Weighed& w, const Line& line, const LoadCellLimits& limits) {
  const double error = *std::ranges::max_element(w.error_N);
  const double largest = *std::ranges::max_element(w.force_N);
  return std::hypot(5.0 * error, limits.max_residual_of_span * largest * std::abs(line.slope));
}

// Selects the reason for a residual that is too large.
Refusal of_residual(const Weighed& w, const Line& line, double allowed) {
  const auto worst = static_cast<std::size_t>(
      std::ranges::max_element(line.residual, {}, [](double r) { return std::abs(r); }) -
      line.residual.begin());
  const auto found = fmt::format("the readings leave the line by up to {:.3f} N, allowed {:.3f} N",
                                 std::abs(line.residual[worst]), allowed);
  if (const auto without = line_without_worst(w.force_N, w.reading_N);
      without && without->largest_residual < allowed)
    return {
        "outlier",
        fmt::format("{}; without {} (reading {}) all others lie on it", found, w.name[without->left_out],
                    without->left_out + 1),
        "see that this weight is what its label says and lay on nothing but the cell, and record it again"};
  if (const auto bend = curvature(w.force_N, w.reading_N); bend && std::abs(bend->t) > bend->t95)
    return {"nonlinear", found + ": it is bent",
            "see that the cell is not overloaded, touches nothing, and is loaded along its axis"};
  return {"residual_too_large", found,
          "see that the weights are known and the cell is loaded along its axis"};
}

void judge(const Weighed& w, const Line& line, const LoadCellLimits& limits, Outcome& out) {
  const double allowed = allowed_N(w, line, limits);
  const auto repeat = worst_repeat(w);
  if (repeat.any && repeat.difference_N > 2.0 * allowed)
    out.refusals.push_back({"repeats_disagree",
                            fmt::format("the same {:.2f} N read {:.3f} N apart, allowed {:.3f} N",
                                        repeat.force_N, repeat.difference_N, 2.0 * allowed),
                            "let the amplifier warm up, see that nothing rubs or slips, and weigh again"});
  else if (line.largest_residual > allowed)
    out.refusals.push_back(of_residual(w, line, allowed));
  if (!repeat.any)
    out.notes.push_back("no weight was put on twice: drift and creep from weight to weight would not show");
}

StudySection section_of(const Weighed& w, const Line& line) {
  StudySection section{.title = "Readings"};
  StudyFigure fit{.title = "Reading against weight", .x_label = "weight, N", .y_label = "reading so far, N"};
  fit.series.push_back({.label = "readings", .x = w.force_N, .y = w.reading_N});
  const auto [low, high] = std::ranges::minmax(w.force_N);
  fit.series.push_back({.label = "fit",
                        .x = {low, high},
                        .y = {line.at(low), line.at(high)},
                        .mark = StudySeries::Mark::line,
                        .color = "orange"});
  StudyFigure residual{.title = "Residuals",
                       .x_label = "weight, N",
                       .y_label = "reading less fit, N",
                       .note = "Bars: 95 % of each mean's own noise."};
  StudySeries series{.label = "residuals", .x = w.force_N, .y = line.residual};
  StudyTable table{.title = "Weights", .columns = {"weight", "force, N", "reading, N", "less fit, N"}};
  for (std::size_t i = 0; i < w.force_N.size(); ++i) {
    series.low.push_back(line.residual[i] - 2.26 * w.error_N[i]);
    series.high.push_back(line.residual[i] + 2.26 * w.error_N[i]);
    table.rows.push_back({w.name[i], fmt::format("{:.3f}", w.force_N[i]),
                          fmt::format("{:.3f}", w.reading_N[i]), fmt::format("{:+.3f}", line.residual[i])});
  }
  residual.series.push_back(series);
  section.items = {fit, residual, table};
  return section;
}

// Converts the line through the readings to keys. The readings were F_before = sign scale (V - zero).
std::vector<CalibratedValue> values_of(const Line& line, const LoadCellConfig& before) {
  const double scale = before.scale_N_per_V / std::abs(line.slope);
  const double sign = line.slope < 0.0 ? -before.sign : before.sign;
  const double per_volt = before.sign * before.scale_N_per_V;
  return {{.key = "load_cell.scale_N_per_V",
           .unit = "N/V",
           .before = before.scale_N_per_V,
           .after = scale,
           .ci95 = scale * line.slope_ci95 / std::abs(line.slope)},
          {.key = "load_cell.zero_V",
           .unit = "V",
           .before = before.zero_V,
           .after = before.zero_V + line.intercept / per_volt,
           .ci95 = std::abs(line.intercept_ci95 / per_volt)},
          {.key = "load_cell.sign", .before = 1.0 * before.sign, .after = sign, .whole = true}};
}

}  // namespace

Outcome calibrate_load_cell(const std::vector<WeighedPoint>& points, const LoadCellConfig& before,
                            const LoadCellLimits& limits) {
  Outcome out{.points = points.size(), .residual_unit = "N"};
  std::set<double> masses;
  for (const auto& point : points) masses.insert(point.mass_kg);
  if (masses.size() < 3) {
    out.refusals.push_back({"too_few_points",
                            fmt::format("{} different weights, at least 3 are needed", masses.size()),
                            "add weights, from nothing to what a hop presses: --weights-kg 0,1,2,5,0"});
    return out;
  }
  const auto weighed = weigh(points, before, limits.gravity_mps2, out.refusals);
  if (!out.refusals.empty()) return out;
  const auto line = fit_line(weighed.force_N, weighed.reading_N, *std::ranges::max_element(weighed.error_N));
  out.residual_rms = line.residual_sd;
  out.targets = {{ConfigFile::board, "load_cell", values_of(line, before)}};
  out.sections = {section_of(weighed, line)};
  judge(weighed, line, limits, out);
  const double relative = line.slope_ci95 / std::abs(line.slope);
  if (relative > limits.max_ci95_relative)
    out.refusals.push_back({"interval_too_wide",
                            fmt::format("the scale is known to {:.2f} % only, {:.2f} % are asked for",
                                        100.0 * relative, 100.0 * limits.max_ci95_relative),
                            "weigh more and heavier weights, each of them twice"});
  return out;
}

}  // namespace sandhopper::calibrate
