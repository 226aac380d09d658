#include "tools/calibrate/tof.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "terrain/trial_statistics.hpp"
#include "tools/calibrate/line.hpp"

namespace sandhopper::calibrate {
namespace {

constexpr double kWander_m = 0.002;  // allowed drift within a recording, beyond noise

struct Measured {
  std::vector<double> height_m, reading_m, error_m, offset_m;
};

Measured measure(const std::vector<HeightPoint>& points, std::vector<Refusal>& refusals) {
  Measured out;
  for (const auto& point : points) {
    const auto series = series_of(point.recording.tof, [](const auto& s) { return s.height_m; });
    const auto mean =
        still_mean(series, {.max_wander = kWander_m},
                   fmt::format("{} ({} m), height in m", point.recording.name, point.height_m), refusals);
    out.height_m.push_back(point.height_m);
    out.reading_m.push_back(mean.value);
    out.error_m.push_back(mean.standard_error);
    out.offset_m.push_back(point.height_m - mean.value);
  }
  return out;
}

void judge(const Measured& m, const Line& line, const TofLimits& limits, std::vector<Refusal>& refusals) {
  const double allowed = std::hypot(limits.max_residual_m, 5.0 * *std::ranges::max_element(m.error_m));
  if (line.largest_residual > allowed) {
    const auto found = fmt::format("the readings leave a line by up to {:.4f} m, allowed {:.4f} m",
                                   line.largest_residual, allowed);
    const auto without = line_without_worst(m.height_m, m.reading_m);
    if (without && without->largest_residual < allowed)
      refusals.push_back({"outlier",
                          fmt::format("{}; without height {} ({:.3f} m) all others lie on it", found,
                                      without->left_out + 1, m.height_m[without->left_out]),
                          "measure this height again"});
    else
      refusals.push_back(
          {"residual_too_large", found, "measure the heights to a millimetre, over one flat surface"});
    return;
  }
  if (std::abs(line.slope - 1.0) > std::max(limits.max_slope_error, line.slope_ci95))
    refusals.push_back(
        {"wrong_slope", fmt::format("a metre more reads {:.4f} m more", line.slope),
         "see that the heights are those of the hip axis, and that the sensor looks straight down on "
         "a surface it sees well"});
}

StudySection section_of(const Measured& m, double offset_m) {
  StudySection section{.title = "Readings"};
  StudyFigure residual{.title = "Height less reading",
                       .x_label = "height, m",
                       .y_label = "height less reading, m",
                       .note = "Line: the offset. Bars: 95 % of each mean's own noise."};
  StudySeries series{.label = "height less reading", .x = m.height_m, .y = m.offset_m};
  StudyTable table{.title = "Heights", .columns = {"height, m", "reading, m", "residual, m"}};
  table.text_columns = 0;
  for (std::size_t i = 0; i < m.height_m.size(); ++i) {
    series.low.push_back(m.offset_m[i] - 2.26 * m.error_m[i]);
    series.high.push_back(m.offset_m[i] + 2.26 * m.error_m[i]);
    table.rows.push_back({fmt::format("{:.4f}", m.height_m[i]), fmt::format("{:.4f}", m.reading_m[i]),
                          fmt::format("{:+.4f}", m.offset_m[i] - offset_m)});
  }
  const auto [low, high] = std::ranges::minmax(m.height_m);
  residual.series = {series,
                     {.label = "offset",
                      .x = {low, high},
                      .y = {offset_m, offset_m},
                      .mark = StudySeries::Mark::line,
                      .color = "orange"}};
  section.items = {residual, table};
  return section;
}

}  // namespace

Outcome calibrate_tof(const std::vector<HeightPoint>& points, const TofConfig& before,
                      const TofLimits& limits) {
  Outcome out{.points = points.size(), .residual_unit = "m"};
  std::set<double> heights;
  for (const auto& point : points) heights.insert(point.height_m);
  if (heights.size() < 3) {
    out.refusals.push_back({"too_few_points",
                            fmt::format("{} different heights, at least 3 are needed", heights.size()),
                            "add heights over the range of a hop: --heights-m 0.3,0.4,0.5"});
    return out;
  }
  const auto measured = measure(points, out.refusals);
  if (!out.refusals.empty()) return out;
  const double least_sd = *std::ranges::max_element(measured.error_m);
  const auto line = fit_line(measured.height_m, measured.reading_m, least_sd);
  const auto offset = mean_over_trials(measured.offset_m);
  const double sd = std::max(offset.standard_deviation, least_sd);
  const double ci95 = student_t95(points.size() - 1) * sd / std::sqrt(static_cast<double>(points.size()));
  out.residual_rms = offset.standard_deviation;
  out.targets = {{ConfigFile::board,
                  "tof",
                  {{.key = "tof.mount_offset_m",
                    .unit = "m",
                    .before = before.mount_offset_m,
                    .after = before.mount_offset_m + offset.value,
                    .ci95 = ci95}}}};
  out.sections = {section_of(measured, offset.value)};
  judge(measured, line, limits, out.refusals);
  if (ci95 > limits.max_ci95_m)
    out.refusals.push_back(
        {"interval_too_wide",
         fmt::format("the offset is known to {:.4f} m only, {} m are asked for", ci95, limits.max_ci95_m),
         "measure more heights, and more exactly"});
  return out;
}

}  // namespace sandhopper::calibrate
