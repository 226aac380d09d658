#include <fmt/format.h>

#include <cmath>

#include "terrain/joint_fit.hpp"
#include "terrain/trial_statistics.hpp"
#include "tools/experiment/treatments.hpp"
#include "tools/terrain/figure_text.hpp"
#include "tools/terrain/hop_trials.hpp"
#include "tools/terrain/mean_json.hpp"

namespace sandhopper {
namespace {

using Json = nlohmann::ordered_json;
using Results = std::span<const TrialResult* const>;

std::vector<std::string> windows() {
  std::vector<std::string> names;
  for (const auto& definition : treatment_cases())
    if (!definition.true_state) names.emplace_back(definition.name);
  return names;
}

std::string window_text(const TreatmentCase& definition) {
  std::string text(name_of(definition.window));
  for (char& c : text)
    if (c == '_') c = ' ';
  return text + (definition.free_intercept ? ", free intercept" : ", through the origin");
}

bool is_joint(std::string_view way) { return way.ends_with("joint"); }

Json stiffness_json(const TrialMean& mean) {
  return {{"value_N_per_m", number_or_null(mean.value)},
          {"ci95_N_per_m", {number_or_null(mean.ci95_low), number_or_null(mean.ci95_high)}},
          {"standard_deviation_N_per_m", number_or_null(mean.standard_deviation)},
          {"trials", mean.trials}};
}

TrialMean stiffness_of(Results results, std::string_view way, std::string_view window) {
  return mean_over_trials(values_of(results, stiffness_name(way, is_joint(way) ? "" : window)));
}

// Pools the strides of beds prepared alike into one stiffness. The force-scale error is common to them.
PooledStiffness pooled_joint(Results results) {
  std::vector<JointEstimate> strides;
  for (const auto* result : results) {
    const auto* quantity = result->find(stiffness_name("joint", ""));
    if (quantity == nullptr || !quantity->invalid.empty()) continue;
    JointEstimate estimate;
    estimate.value_N_per_m = quantity->value;
    estimate.standard_error_N_per_m = quantity->standard_error;
    estimate.validity = Validity::valid;
    strides.push_back(estimate);
  }
  return pool_strides(strides, {});
}

StudyTable treatment_table(Results results) {
  StudyTable table{
      .title = "Stiffness by treatment and window, mean over trials, N/m",
      .columns = {"window", "samples"},
      .text_columns = 2,
      .note =
          "In brackets the 95 % interval of the mean, from the spread between trials, and the number "
          "of trials that gave a usable figure."};
  for (const auto& way : stiffness_ways())
    if (!is_joint(way.name)) table.columns.emplace_back(way.title);
  for (const auto& definition : treatment_cases()) {
    if (definition.true_state) continue;
    std::vector<std::string> row{std::string(definition.name), window_text(definition)};
    for (const auto& way : stiffness_ways()) {
      if (is_joint(way.name)) continue;
      const auto mean = stiffness_of(results, way.name, definition.name);
      row.push_back(mean.trials == 0
                        ? "–"
                        : fmt::format("{} ({}; {})", value_text(mean.value, mean.ci95_low, mean.ci95_high),
                                      interval_text(mean.ci95_low, mean.ci95_high), mean.trials));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

StudyFigure window_figure(Results results) {
  StudyFigure figure{.title = "Stiffness by window",
                     .x_label = "sample window",
                     .y_label = "stiffness, N/m",
                     .categories = windows(),
                     .note = "Bars: 95 % interval of the mean over trials."};
  const double count = static_cast<double>(stiffness_ways().size());
  for (std::size_t i = 0; i < stiffness_ways().size(); ++i) {
    const auto& way = stiffness_ways()[i];
    if (is_joint(way.name)) continue;
    StudySeries series{.label = std::string(way.title), .color = std::string(way.color)};
    for (std::size_t w = 0; w < figure.categories.size(); ++w) {
      const auto mean = stiffness_of(results, way.name, figure.categories[w]);
      if (mean.trials == 0) continue;
      series.x.push_back(static_cast<double>(w) + 0.5 * (static_cast<double>(i) + 0.5) / count - 0.2);
      series.y.push_back(mean.value);
      series.low.push_back(mean.ci95_low);
      series.high.push_back(mean.ci95_high);
    }
    if (!series.x.empty()) figure.series.push_back(std::move(series));
  }
  return figure;
}

// Figure of each trial's stiffness against a property that differs between the trials.
StudyFigure against(Results results, std::string_view x_name, const std::string& x_label) {
  StudyFigure figure{
      .title = fmt::format("Stiffness against {}", x_label.substr(0, x_label.find(','))),
      .x_label = x_label,
      .y_label = "stiffness, N/m",
      .note = "One point a trial, straight lines in window A. Bars: two standard errors of the joint fit."};
  for (const auto& way : stiffness_ways()) {
    StudySeries series{.label = std::string(way.title), .color = std::string(way.color)};
    for (const auto* result : results) {
      const double setup = result->setup_number(x_name);
      const double x = std::isfinite(setup) ? setup : result->value(x_name);
      const auto name = stiffness_name(way.name, is_joint(way.name) ? "" : "A");
      const double y = result->value(name);
      if (!std::isfinite(x) || !std::isfinite(y)) continue;
      series.x.push_back(page_scale(x_name) * x);
      series.y.push_back(y);
      if (!is_joint(way.name)) continue;
      const double error = result->find(name)->standard_error;
      series.low.push_back(y - 2.0 * error);
      series.high.push_back(y + 2.0 * error);
    }
    series.shown = way.name != "load_cell_joint";
    if (!series.x.empty()) figure.series.push_back(std::move(series));
  }
  return figure;
}

StudyFigure force_depth(const TrialResult& result) {
  StudyFigure figure{.title = fmt::format("Force against depth, {}", result.trial),
                     .x_label = "depth, mm",
                     .y_label = "force, N",
                     .note =
                         "The whole stance, unloading included. The quasi-static force lacks the inertia of "
                         "leg and foot."};
  for (const auto& [key, title, color] : {std::tuple{"load_cell", "load cell, motion capture", "sand"},
                                          std::tuple{"quasi_static", "quasi-static", "orange"},
                                          std::tuple{"observer", "momentum observer", "blue"}}) {
    const auto depth = result.series.find(std::string(key) + "_depth_m");
    const auto force = result.series.find(std::string(key) + "_force_N");
    if (depth == result.series.end() || force == result.series.end()) continue;
    StudySeries series{.label = title, .mark = StudySeries::Mark::line, .color = color};
    for (const double value : depth->second) series.x.push_back(1e3 * value);
    series.y = force->second;
    figure.series.push_back(std::move(series));
  }
  return figure;
}

StudyFigure error_figure(Results results) {
  StudyFigure figure{.title = "Force error in stance against the load cell",
                     .x_label = "touchdown speed, m/s",
                     .y_label = "rms of the difference, N",
                     .note = "One point a trial: difference between the estimated and the measured force."};
  for (const auto& [name, title, color] :
       {std::tuple{"quasi_static_force_error_rms_N", "quasi-static", "orange"},
        std::tuple{"observer_force_error_rms_N", "momentum observer", "blue"}}) {
    StudySeries series{.label = title, .color = color};
    for (const auto* result : results) {
      const double y = result->value(name);
      if (!std::isfinite(y)) continue;
      series.x.push_back(result->value("touchdown_speed_mps"));
      series.y.push_back(y);
    }
    if (!series.x.empty()) figure.series.push_back(std::move(series));
  }
  return figure;
}

bool differs(Results results, std::string_view key) {
  for (const auto* result : results)
    if (result->setup_number(key) != results.front()->setup_number(key) &&
        std::isfinite(result->setup_number(key)))
      return true;
  return false;
}

Json treatments_json(Results results) {
  Json json = Json::object();
  for (const auto& way : stiffness_ways()) {
    if (is_joint(way.name)) {
      json[std::string(way.name)] = stiffness_json(stiffness_of(results, way.name, ""));
      continue;
    }
    for (const auto& window : windows())
      json[std::string(way.name)][window] = stiffness_json(stiffness_of(results, way.name, window));
  }
  return json;
}

std::string introduction(const PooledStiffness& pooled) {
  const std::string what =
      "The firmware's own Kalman filter, momentum observer and fits, run on the recorded channels. "
      "The joint fit takes depth, drag and added mass together";
  const std::string lines =
      "The straight lines take drag and inertia for stiffness, so they depend on the window.";
  if (pooled.strides == 0)
    return fmt::format("{}; no stride here allows it (\"Trial by trial\" says why). {}", what, lines);
  return fmt::format(
      "{}: {} N/m (95 % interval of the mean {}, {} strides; sd from stride to stride {} N/m). {}", what,
      value_text(pooled.value_N_per_m, pooled.ci95_low_N_per_m, pooled.ci95_high_N_per_m),
      interval_text(pooled.ci95_low_N_per_m, pooled.ci95_high_N_per_m), pooled.strides,
      value_text(pooled.between_strides_sd_N_per_m, 0.0, 2.0 * pooled.between_strides_sd_N_per_m), lines);
}

StudySection stiffness_section(Results results, const PooledStiffness& pooled) {
  StudySection section{.title = "Stiffness of the ground from hops"};
  section.items.emplace_back(introduction(pooled));
  section.items.emplace_back(treatment_table(results));
  section.items.emplace_back(window_figure(results));
  section.items.emplace_back(against(results, "touchdown_speed_mps", "touchdown speed, m/s"));
  for (const auto& [key, label] :
       {std::pair{"compression_stiffness_N_per_m", "compression stiffness, N/m"},
        std::pair{"release_height_m", "release height, mm"}, std::pair{"payload_kg", "payload, kg"}})
    if (differs(results, key)) section.items.emplace_back(against(results, key, label));
  return section;
}

// The campaign's stiffness in one sentence, or the reason why there is none.
std::string answer_of(const PooledStiffness& pooled) {
  if (pooled.strides == 0) return "No stride gives a stiffness of the ground.";
  if (!std::isfinite(pooled.ci95_low_N_per_m))
    return fmt::format("One stride gives {} N/m for the ground's stiffness; an interval needs more of them.",
                       figure_number(pooled.value_N_per_m));
  const auto interval = interval_text(pooled.ci95_low_N_per_m, pooled.ci95_high_N_per_m);
  if (pooled.ci95_low_N_per_m <= 0.0)
    return fmt::format(
        "No stiffness of the ground can be given: the interval over {} strides, {} N/m, holds "
        "zero.",
        pooled.strides, interval);
  return fmt::format("The ground's stiffness is {} N/m, 95 % interval {} N/m (joint fit, {} strides).",
                     value_text(pooled.value_N_per_m, pooled.ci95_low_N_per_m, pooled.ci95_high_N_per_m),
                     interval, pooled.strides);
}

}  // namespace

CampaignConclusions conclude_hops(Results results) {
  CampaignConclusions told;
  const auto pooled = pooled_joint(results);
  told.json["treatments"] = treatments_json(results);
  told.json["joint_pooled"] = {{"value_N_per_m", pooled.value_N_per_m},
                               {"ci95_N_per_m", {pooled.ci95_low_N_per_m, pooled.ci95_high_N_per_m}},
                               {"between_strides_sd_N_per_m", pooled.between_strides_sd_N_per_m},
                               {"strides", pooled.strides}};
  told.answer = answer_of(pooled);
  told.lines.push_back(fmt::format("hops: {} trials", results.size()));
  for (const auto& way : stiffness_ways()) {
    const auto mean = stiffness_of(results, way.name, "A");
    if (mean.trials == 0) continue;
    if (way.name == "joint" && pooled.strides > 1) {  // the number of the answer
      told.lines.push_back(
          fmt::format("  {:22} {} N/m; {} strides, each weighted by its own error", way.title,
                      with_interval(pooled.value_N_per_m, pooled.ci95_low_N_per_m, pooled.ci95_high_N_per_m),
                      pooled.strides));
      continue;
    }
    told.lines.push_back(fmt::format("  {:22} {} N/m; {} trials", way.title,
                                     with_interval(mean.value, mean.ci95_low, mean.ci95_high), mean.trials));
  }
  told.sections.push_back(stiffness_section(results, pooled));
  StudySection forces{.title = "Force and depth"};
  for (const auto* result : results)
    if (auto figure = force_depth(*result); !figure.series.empty())
      forces.items.emplace_back(std::move(figure));
  if (auto errors = error_figure(results); !errors.series.empty())
    forces.items.emplace_back(std::move(errors));
  if (!forces.items.empty()) told.sections.push_back(std::move(forces));
  return told;
}

}  // namespace sandhopper
