#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/experiment/statistics.hpp"
#include "tools/terrain/figure_text.hpp"
#include "tools/terrain/mean_json.hpp"
#include "tools/terrain/stroke_map.hpp"
#include "tools/terrain/stroke_trials.hpp"

namespace sandhopper {
namespace {

using Json = nlohmann::ordered_json;
using Results = std::span<const TrialResult* const>;

constexpr double kInertialSpeed_mps = 0.0767;  // sqrt(2 d g) of 0.3 mm beads: below it speed does not matter
constexpr double kFastest_mps = 0.3;           // from this speed on drag is visible

// Strokes with plates of one size, whose forces share one map.
struct Plate {
  double diameter_m = 0.0;
  std::vector<const TrialResult*> trials;
  std::vector<StrokeSums> sums;
  bool inertia_known = true;
  double fastest_mps = 0.0;

  bool tells_drag() const { return fastest_mps >= kFastest_mps && trials.size() >= 3; }
  // Reason why there is no drag, with the recordings that would be needed.
  std::string why_no_drag() const {
    if (trials.size() < 3)
      return fmt::format(
          "stiffness at rest, drag and added mass need three strokes of one plate, there {} {}",
          trials.size() == 1 ? "is" : "are", trials.size());
    return fmt::format(
        "stiffness at rest, drag and added mass need strokes faster than {} m/s, the fastest has {:.2g}",
        kFastest_mps, fastest_mps);
  }
};

// Mean slope of a straight line through each stroke at any speed.
TrialMean any_slope(const Plate& plate) {
  std::vector<double> slopes;
  for (const auto* trial : plate.trials) slopes.push_back(trial->value("slope_N_per_m"));
  return mean_over_trials(slopes);
}

std::vector<Plate> plates_of(Results results) {
  std::vector<Plate> plates;
  for (const auto* result : results) {
    const auto facts = result->series.find("stroke");
    if (facts == result->series.end()) continue;
    const double diameter_m = facts->second.at(0);
    auto same = std::find_if(plates.begin(), plates.end(), [&](const Plate& plate) {
      return std::abs(plate.diameter_m / diameter_m - 1.0) < 1e-6;
    });
    if (same == plates.end())
      same = plates.insert(plates.end(), Plate{.diameter_m = diameter_m, .trials = {}, .sums = {}});
    same->trials.push_back(result);
    same->sums.push_back(StrokeSums::from(result->series.at("stroke_sums")));
    same->fastest_mps = std::max(same->fastest_mps, facts->second.at(1));
    same->inertia_known = same->inertia_known && facts->second.at(2) > 0.0;
  }
  return plates;
}

std::string mean_text(const TrialMean& mean) {
  return fmt::format("{} ({})", value_text(mean.value, mean.ci95_low, mean.ci95_high),
                     interval_text(mean.ci95_low, mean.ci95_high));
}

double speed_of(const TrialResult& result) { return result.series.at("stroke").at(1); }

// Mean slope of the strokes that are too slow for inertia.
TrialMean slow_slope(const Plate& plate) {
  std::vector<double> slopes;
  for (const auto* trial : plate.trials)
    if (speed_of(*trial) < kInertialSpeed_mps) slopes.push_back(trial->value("slope_N_per_m"));
  return mean_over_trials(slopes);
}

// Exponent p of k ~ A^p from each trial's own stiffness. For slow trials it is the slope, because a joint fit
// cannot separate the inertial terms from depth there.
struct AreaLaw {
  double exponent = NAN, half_width = NAN;
  std::size_t trials = 0;
};
AreaLaw area_law(const std::vector<Plate>& plates) {
  std::vector<double> area, stiffness;
  for (const auto& plate : plates)
    for (const auto* trial : plate.trials) {
      const bool slow = speed_of(*trial) < kInertialSpeed_mps;
      const double k = trial->value(slow ? "slope_N_per_m" : "stiffness_joint_N_per_m");
      if (!(k > 0.0)) continue;
      area.push_back(std::log(0.25 * std::numbers::pi * plate.diameter_m * plate.diameter_m));
      stiffness.push_back(std::log(k));
    }
  AreaLaw law{.trials = area.size()};
  if (plates.size() < 2 || area.size() < 4) return law;
  const auto line = fit_line(area, stiffness);
  const double n = static_cast<double>(area.size()), spread = standard_deviation(area);
  const double error = line.rms * std::sqrt(n / (n - 2.0)) / (spread * std::sqrt(n - 1.0));
  law.exponent = line.slope;
  law.half_width = student_t95(area.size() - 2) * error;
  return law;
}

StudyFigure slope_figure(const std::vector<Plate>& plates) {
  StudyFigure figure{
      .title = "Stiffness of each stroke against its speed",
      .x_label = "speed, m/s",
      .y_label = "stiffness, N/m",
      .note =
          "A straight line through force and depth bends with the drag at the surface and falls with "
          "speed; the joint fit does not."};
  constexpr std::array<const char*, 3> kColors{"blue", "orange", "green"};
  for (std::size_t i = 0; i < plates.size(); ++i)
    for (const auto& [name, title, color] :
         {std::tuple{"slope_N_per_m", "straight line", kColors[i % 3]},
          std::tuple{"stiffness_joint_N_per_m", "joint fit", i % 2 == 0 ? "purple" : "sand"}}) {
      StudySeries series{.label = fmt::format("{}, {:.0f} mm", title, 1e3 * plates[i].diameter_m),
                         .color = color};
      for (const auto* trial : plates[i].trials) {
        if (!std::isfinite(trial->value(name))) continue;
        series.x.push_back(speed_of(*trial));
        series.y.push_back(trial->value(name));
      }
      if (!series.x.empty()) figure.series.push_back(std::move(series));
    }
  return figure;
}

StudyFigure residual_figure(const Plate& plate, const StrokeMap& map) {
  StudyFigure figure{
      .title = fmt::format("Residual of the force, {:.0f} mm plate", 1e3 * plate.diameter_m),
      .x_label = "speed, m/s",
      .y_label = "rms of the residual, N",
      .note =
          "Samples at new depths. The line is fitted to each stroke by itself, the map and the added "
          "mass to all strokes together."};
  StudySeries line{.label = "line of the stroke", .color = "grey"},
      speed{.label = "depth-speed map", .color = "blue"},
      inertia{.label = "map and added mass", .color = "orange"};
  for (std::size_t i = 0; i < plate.trials.size(); ++i) {
    const auto left = stroke_residuals(plate.sums[i], map);
    for (auto* series : {&line, &speed, &inertia}) series->x.push_back(speed_of(*plate.trials[i]));
    line.y.push_back(left.line_rms_N);
    speed.y.push_back(left.map_rms_N);
    inertia.y.push_back(left.added_mass_rms_N);
  }
  figure.series = {line, speed};
  if (plate.inertia_known) figure.series.push_back(inertia);
  return figure;
}

StudyFigure profile_figure(const Plate& plate, const StrokeMap& map) {
  StudyFigure figure{.title = fmt::format("Added mass, {:.0f} mm plate", 1e3 * plate.diameter_m),
                     .x_label = "depth, mm",
                     .y_label = "added mass, kg",
                     .note = "Integral of the drag coefficient over depth."};
  StudySeries series{.label = "added mass", .mark = StudySeries::Mark::line};
  for (int mm = 0; mm <= 45; ++mm) {
    series.x.push_back(mm);
    series.y.push_back(map.added_mass_kg(1e-3 * mm));
  }
  figure.series.push_back(std::move(series));
  return figure;
}

StudyFigure path_figure(Results results) {
  StudyFigure figure{
      .title = "Force against depth, first strokes", .x_label = "depth, mm", .y_label = "force, N"};
  for (const auto* result : results) {
    const auto depth = result->series.find("stroke_depth_m");
    if (depth == result->series.end()) continue;
    StudySeries series{.label = fmt::format("{}, {:.2g} m/s", result->trial, speed_of(*result)),
                       .mark = StudySeries::Mark::line};
    tell_apart(series, figure.series.size());
    for (const double value : depth->second) series.x.push_back(1e3 * value);
    series.y = result->series.at("stroke_force_N");
    figure.series.push_back(std::move(series));
  }
  return figure;
}

// Table row, JSON entry and figures of one plate.
struct PlateReport {
  std::vector<std::string> row;
  Json json;
  std::vector<StudyFigure> figures;
};

PlateReport report_plate(const Plate& plate) {
  const auto terms = plate.inertia_known ? StrokeTerms::with_added_mass : StrokeTerms::depth_and_speed;
  const auto map = fit_stroke_map(plate.sums, terms);
  const auto slow = slow_slope(plate);
  PlateReport out;
  out.json = {{"plate_diameter_m", plate.diameter_m},
              {"trials", plate.trials.size()},
              {"slow_slope_N_per_m", mean_json(slow)}};
  out.row = {fmt::format("{:.0f}", 1e3 * plate.diameter_m), fmt::format("{}", plate.trials.size()),
             mean_text(slow)};
  if (!plate.tells_drag()) {
    out.json["ruled_out"] = plate.why_no_drag();
    out.json["slope_N_per_m"] = mean_json(any_slope(plate));
    out.row.insert(out.row.end(), {"–", "–", "–", "–"});
    return out;
  }
  std::vector<double> speed_only, with_mass, correlation;
  for (std::size_t i = 0; i < plate.trials.size(); ++i) {
    if (speed_of(*plate.trials[i]) < 0.7) continue;
    const auto left = stroke_residuals(plate.sums[i], map.map);
    speed_only.push_back(left.map_rms_N);
    with_mass.push_back(left.added_mass_rms_N);
    correlation.push_back(left.correlation);
  }
  out.json["stiffness_N_per_m"] = mean_json(map.stiffness_N_per_m);
  out.json["intercept_N"] = mean_json(map.intercept_N);
  out.json["drag_at_surface_kg_per_m"] = mean_json(map.drag_at_surface_kg_per_m);
  out.json["drag_coefficients"] = map.map.drag_coefficient;
  out.json["added_mass_at_30mm_kg"] = mean_json(map.added_mass_at_30mm_kg);
  out.json["fast_strokes"] = {{"from_mps", 0.7}, {"strokes", speed_only.size()}};
  if (!speed_only.empty() && plate.inertia_known)
    out.json["fast_strokes"].update({{"map_rms_N", mean(speed_only)},
                                     {"map_and_added_mass_rms_N", mean(with_mass)},
                                     {"correlation", mean(correlation)}});
  out.row.insert(out.row.end(),
                 {mean_text(map.stiffness_N_per_m), mean_text(map.intercept_N),
                  mean_text(map.drag_at_surface_kg_per_m), mean_text(map.added_mass_at_30mm_kg)});
  out.figures = {residual_figure(plate, map.map), profile_figure(plate, map.map)};
  return out;
}

}  // namespace

CampaignConclusions conclude_strokes(Results results) {
  CampaignConclusions conclusions;
  const auto plates = plates_of(results);
  // Slow presses alone are evaluated by the depth law.
  const bool fast = std::any_of(plates.begin(), plates.end(),
                                [](const Plate& plate) { return plate.fastest_mps > kInertialSpeed_mps; });
  if (!fast) return conclusions;
  StudySection section{.title = "Depth, speed and acceleration"};
  StudyTable table{
      .title = "All strokes of a plate together",
      .columns = {"plate, mm", "strokes", "slow strokes' slope, N/m", "stiffness, N/m", "intercept, N",
                  "drag at the surface, kg/m", "added mass at 30 mm, kg"},
      .text_columns = 0,
      .note =
          "F = F0 + k z + (a + b z + c z²) v² + m_a(z) z̈ with m_a the integral of the drag; 95 % intervals "
          "by leaving out one stroke after the other. Slow: below 0.077 m/s. –: needs three strokes, one of "
          "them faster than 0.3 m/s."};
  std::vector<StudyFigure> figures{path_figure(results), slope_figure(plates)};
  const auto fused = std::count_if(results.begin(), results.end(), [](const TrialResult* result) {
    const auto facts = result->series.find("stroke");
    return facts != result->series.end() && facts->second.at(3) > 0.0;
  });
  conclusions.json["speed_from_camera_and_accelerometer"] = fused;
  if (fused > 0)
    section.items.emplace_back(
        fmt::format("In {} strokes the speed was not recorded: it comes from depth and acceleration "
                    "together (Kalman filter and Rauch-Tung-Striebel smoother).",
                    fused));
  auto& list = conclusions.json["plates"] = Json::array();
  for (const auto& plate : plates) {
    auto report = report_plate(plate);
    table.rows.push_back(report.row);
    std::move(report.figures.begin(), report.figures.end(), std::back_inserter(figures));
    if (!plate.tells_drag())
      conclusions.lines.push_back(fmt::format(
          "Strokes with the {:.0f} mm plate, {} trials: slope of a straight line {} N/m; {}.",
          1e3 * plate.diameter_m, plate.trials.size(), mean_text(any_slope(plate)), plate.why_no_drag()));
    else
      conclusions.lines.push_back(fmt::format(
          "Strokes with the {:.0f} mm plate, {} trials: stiffness {} N/m, drag at the surface {} kg/m, added "
          "mass at 30 mm {} kg.",
          1e3 * plate.diameter_m, plate.trials.size(), report.row[3], report.row[5], report.row[6]));
    list.push_back(std::move(report.json));
  }
  if (const auto law = area_law(plates); std::isfinite(law.exponent)) {
    const auto text =
        fmt::format("stiffness grows with the plate's area to the power {}; {} strokes",
                    with_interval(law.exponent, law.exponent - law.half_width, law.exponent + law.half_width),
                    law.trials);
    conclusions.lines.push_back("  " + text);
    conclusions.json["area_exponent"] = {
        {"value", law.exponent},
        {"ci95", {law.exponent - law.half_width, law.exponent + law.half_width}},
        {"trials", law.trials}};
    section.items.emplace_back("Over all plates the " + text + ".");
  }
  section.items.emplace_back(std::move(table));
  for (auto& figure : figures) section.items.emplace_back(std::move(figure));
  conclusions.sections.push_back(std::move(section));
  return conclusions;
}

}  // namespace sandhopper
