#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/terrain/figure_text.hpp"
#include "tools/terrain/mean_json.hpp"
#include "tools/terrain/press_trials.hpp"

namespace sandhopper {
namespace {

using Json = nlohmann::ordered_json;

std::string percent(double share) {
  return std::isfinite(share) ? fmt::format("{:+.1f} %", 100.0 * share) : "–";
}

std::string mean_text(const TrialMean& mean, double scale) {
  return fmt::format("{} ({})", value_text(scale * mean.value, scale * mean.ci95_low, scale * mean.ci95_high),
                     interval_text(scale * mean.ci95_low, scale * mean.ci95_high));
}

struct LawText {
  const char* equation;
  const char* shape;
  double scale;
  const char* unit;
};
LawText text_of(DepthLaw law) {
  switch (law) {
    case DepthLaw::linear:
      return {"K A z", "–", 1.0, ""};
    case DepthLaw::power:
      return {"K A z (z/1 cm)^(n−1)", "exponent n", 1.0, ""};
    case DepthLaw::cone:
      return {"K A [z + c D (1 − exp(−z/0.1 D))]", "cone factor c", 1.0, ""};
    case DepthLaw::floor_stiffening:
      return {"K A z [1 + exp(−(H−z)/0.25 D)]", "floor H, mm", 1e3, "mm"};
    case DepthLaw::confined_layer:
      return {"K A z · 2 (exp(x) − x − 1)/x², x = K_p tan φ D/(H−z)", "layer H, mm", 1e3, "mm"};
  }
  return {"", "", 1.0, ""};
}

std::string title_of(DepthLaw law) {
  std::string title(name_of(law));
  std::replace(title.begin(), title.end(), '_', ' ');
  return title;
}

StudyTable law_table(const IntrusionFit& fit) {
  StudyTable table{.title = "Laws, fitted on the trials that are not held out",
                   .columns = {"law", "equation", "shape", "K, N/cm³ (95 % interval)",
                               "shape (95 % interval)", "rms, N", "left out, N"},
                   .text_columns = 3};
  for (std::size_t i = 0; i < fit.laws.size(); ++i) {
    const auto& law = fit.laws[i];
    const auto text = text_of(law.fit.law);
    table.rows.push_back({title_of(law.fit.law) + (fit.chosen == i ? " (chosen)" : ""),
                          fmt::format("F = {}", text.equation), text.shape,
                          mean_text(law.stiffness_per_area_N_per_m3, 1e-6),
                          law.fit.law == DepthLaw::linear ? "–" : mean_text(law.shape, text.scale),
                          rounded_text(law.fit.rms_N), rounded_text(law.cross_validation_N)});
  }
  table.note = fmt::format(
      "K and shape: mean over trials fitted one by one, Student's t with {} degrees of freedom. Left out: "
      "rms "
      "on each trial under the fit on the others; the law with the least is chosen. φ = {:.0f}°, not fitted.",
      fit.fit_trials > 0 ? fit.fit_trials - 1 : 0, fit.options.friction_angle_rad * 180.0 / std::numbers::pi);
  return table;
}

StudyTable prediction_table(const IntrusionFit& fit) {
  StudyTable table{.title = "Held-out trials under every law", .columns = {"law", "rms, N"}};
  for (const double depth_m : kPredictedDepths_m)
    table.columns.push_back(fmt::format("error at {:.0f} mm", 1e3 * depth_m));
  const auto add = [&](const LawResult& law, const std::string& name) {
    std::vector<std::string> row{name, rounded_text(law.heldout_rms_N)};
    for (const double error : law.relative_error) row.push_back(percent(error));
    table.rows.push_back(std::move(row));
  };
  for (std::size_t i = 0; i < fit.laws.size(); ++i)
    add(fit.laws[i], title_of(fit.laws[i].fit.law) + (fit.chosen == i ? " (chosen)" : ""));
  if (fit.with_stop_compliance)
    add(*fit.with_stop_compliance,
        title_of(fit.with_stop_compliance->fit.law) + ", the stop's compliance taken off");
  table.note = "Predicted over measured force, mean over the held-out trials.";
  return table;
}

StudyTable trial_table(const LawResult& chosen) {
  StudyTable table{.title = "Held-out trials under the chosen law",
                   .columns = {"trial", "plate, mm", "rms, N"}};
  for (const double depth_m : kPredictedDepths_m)
    table.columns.push_back(fmt::format("predicted / measured at {:.0f} mm, N", 1e3 * depth_m));
  for (const auto& p : chosen.predictions) {
    std::vector<std::string> row{trial_label(p.trial), figure_number(1e3 * p.diameter_m),
                                 rounded_text(p.rms_N)};
    for (std::size_t i = 0; i < p.measured_N.size(); ++i)
      row.push_back(fmt::format("{} / {}", rounded_text(p.predicted_N[i]), rounded_text(p.measured_N[i])));
    table.rows.push_back(std::move(row));
  }
  return table;
}

StudyFigure force_figure(const IntrusionFit& fit, std::span<const PressTrial> trials) {
  StudyFigure figure{
      .title = "Force against depth", .x_label = "depth, mm", .y_label = "force, N", .wide = true};
  std::vector<double> diameters;
  for (const auto& trial : trials) {
    if (trial.on_stop || trial.loading.samples.empty()) continue;
    StudySeries series{
        .label = trial_label(trial.trial) + (trial.held_out ? " (held out)" : ""), .x = {}, .y = {}};
    tell_apart(series, figure.series.size());
    series.hollow = trial.held_out;
    for (const auto& sample : trial.loading.samples) {
      series.x.push_back(1e3 * sample.depth_m);
      series.y.push_back(sample.force_N);
    }
    figure.series.push_back(std::move(series));
    if (std::find(diameters.begin(), diameters.end(), trial.loading.diameter_m) == diameters.end())
      diameters.push_back(trial.loading.diameter_m);
  }
  if (!fit.chosen) return figure;
  for (const auto& [index, dashed] :
       {std::pair{*fit.chosen, false}, std::pair{static_cast<std::size_t>(DepthLaw::power), true}}) {
    if (dashed && index == *fit.chosen) continue;
    const auto& law = fit.laws[index].fit;
    StudySeries line{.label = title_of(law.law) + " law",
                     .x = {},
                     .y = {},
                     .mark = StudySeries::Mark::line,
                     .color = "text",
                     .dashed = dashed};
    for (const double diameter_m : diameters) {
      double deepest_m = 0.0;
      for (const auto& trial : trials)
        if (trial.loading.diameter_m == diameter_m)
          for (const auto& sample : trial.loading.samples) deepest_m = std::max(deepest_m, sample.depth_m);
      for (int i = 0; i <= 100; ++i) {
        line.x.push_back(1e3 * deepest_m * i / 100);
        line.y.push_back(depth_law_force_N(law, deepest_m * i / 100, diameter_m, fit.options));
      }
      line.x.push_back(NAN);  // NaN ends the line before the next plate's line
      line.y.push_back(NAN);
    }
    figure.series.push_back(std::move(line));
  }
  figure.note = "Lines, one for each plate: the chosen law";
  if (*fit.chosen != static_cast<std::size_t>(DepthLaw::power)) figure.note += " and, dashed, the power law";
  figure.note += ", fitted on the trials that are not held out.";
  if (fit.held_out_trials > 0) figure.note += " Rings: trials held out.";
  return figure;
}

StudyFigure rig_figure(std::span<const PressTrial> trials) {
  StudyFigure figure{.title = "Unloading: the rig on a rigid stop, and in the bed",
                     .x_label = "displacement from the greatest force, mm",
                     .y_label = "force, N"};
  for (const auto& trial : trials) {
    const auto& z = trial.path_displacement_m;
    const auto& f = trial.path_force_N;
    if (f.empty() || (!trial.on_stop && trial.held_out)) continue;
    const auto peak = static_cast<std::size_t>(std::max_element(f.begin(), f.end()) - f.begin());
    StudySeries series{.label = trial_label(trial.trial) + (trial.on_stop ? " (stop)" : " (bed)"),
                       .x = {},
                       .y = {},
                       .mark = StudySeries::Mark::line_and_points};
    tell_apart(series, figure.series.size());
    for (std::size_t i = trial.on_stop ? 0 : peak; i < f.size(); ++i) {
      if (z[i] < z[peak] - 5e-3) continue;
      series.x.push_back(1e3 * (z[i] - z[peak]));
      series.y.push_back(f[i]);
    }
    figure.series.push_back(std::move(series));
  }
  return figure;
}

// Accuracy of the chosen law's prediction, in words.
std::string prediction_text(const IntrusionFit& fit) {
  const auto& chosen = fit.laws[*fit.chosen];
  std::string text;
  for (std::size_t i = 0; i < chosen.predicted_N.size(); ++i)
    text += fmt::format("{}{:.0f} mm: {} N", text.empty() ? "" : "; ", 1e3 * kPredictedDepths_m[i],
                        mean_text(chosen.predicted_N[i], 1.0));
  text = fmt::format(
      "Predicted from each fitted trial alone, mean and 95 % interval of that mean over trials: {}.", text);
  if (fit.friction_angle_sensitivity)
    text += fmt::format(" With the friction angle 5° lower and higher the error at {:.0f} mm is {} and {}.",
                        1e3 * kPredictedDepths_m.back(), percent(fit.friction_angle_sensitivity->first),
                        percent(fit.friction_angle_sensitivity->second));
  return text;
}

std::string rig_text(const RigResult& rig) {
  std::string text = rig.why;
  if (rig.stop_compliance_m_per_N.trials > 0)
    text += fmt::format(
        " On the stop: compliance {} µm/N above a quarter of the greatest force, after a soft start of {} "
        "mm; "
        "unloading stiffness {} N/m.",
        mean_text(rig.stop_compliance_m_per_N, 1e6), mean_text(rig.toe_m, 1e3),
        mean_text(rig.stop_unloading_N_per_m, 1.0));
  if (rig.bed_unloading_N_per_m.trials > 0)
    text +=
        fmt::format(" In the bed: unloading stiffness {} N/m.", mean_text(rig.bed_unloading_N_per_m, 1.0));
  return text;
}

std::string area_text(const std::vector<AreaExponent>& area) {
  std::string text;
  for (const auto& a : area)
    text += fmt::format("{}{:.0f} mm: {} ({})", text.empty() ? "" : "; ", 1e3 * a.depth_m,
                        value_text(a.exponent.value, a.exponent.ci95_low, a.exponent.ci95_high),
                        interval_text(a.exponent.ci95_low, a.exponent.ci95_high));
  return fmt::format("Exponent p of the plate's area A, if force ~ Aᵖ at one depth{}: p at {}.",
                     area.front().from_held_out ? " (found afterwards, with the held-out plates)" : "", text);
}

Json law_json(const LawResult& law) {
  Json json{{"law", name_of(law.fit.law)},
            {"stiffness_per_area_N_per_m3", mean_json(law.stiffness_per_area_N_per_m3)},
            {"shape", mean_json(law.shape)},
            {"pooled_stiffness_per_area_N_per_m3", number_or_null(law.fit.stiffness_per_area_N_per_m3)},
            {"pooled_shape", number_or_null(law.fit.shape)},
            {"rms_N", number_or_null(law.fit.rms_N)},
            {"leave_one_trial_out_rms_N", number_or_null(law.cross_validation_N)},
            {"held_out_rms_N", number_or_null(law.heldout_rms_N)}};
  for (const auto& force : law.predicted_N) json["predicted_from_each_trial_N"].push_back(mean_json(force));
  for (std::size_t i = 0; i < law.relative_error.size(); ++i)
    json["held_out_relative_error"][fmt::format("{:.0f}_mm", 1e3 * kPredictedDepths_m[i])] =
        number_or_null(law.relative_error[i]);
  return json;
}

Json json_of(const IntrusionFit& fit) {
  Json json{{"fit_trials", fit.fit_trials}, {"held_out_trials", fit.held_out_trials}};
  for (const auto& law : fit.laws) json["laws"].push_back(law_json(law));
  if (fit.chosen) json["chosen"] = law_json(fit.laws[*fit.chosen]);
  json["rig"] = {{"stop_compliance_m_per_N", mean_json(fit.rig.stop_compliance_m_per_N)},
                 {"stop_unloading_N_per_m", mean_json(fit.rig.stop_unloading_N_per_m)},
                 {"bed_unloading_N_per_m", mean_json(fit.rig.bed_unloading_N_per_m)},
                 {"compliance_used_m_per_N", fit.rig.compliance_used_m_per_N},
                 {"why", fit.rig.why}};
  if (fit.friction_angle_sensitivity)
    json["held_out_error_with_friction_angle_5_deg_lower_and_higher"] = {
        fit.friction_angle_sensitivity->first, fit.friction_angle_sensitivity->second};
  for (const auto& a : fit.area)
    json["area_exponent"].push_back({{"depth_m", a.depth_m}, {"exponent", mean_json(a.exponent)}});
  return json;
}

std::string line_of(const IntrusionFit& fit) {
  if (!fit.chosen) return "No trial presses into a bed.";
  const auto& law = fit.laws[*fit.chosen];
  const auto text = text_of(law.fit.law);
  auto line = fmt::format("Depth law of {} presses: {}, F = {} with K = {} N/cm³", fit.fit_trials,
                          title_of(law.fit.law), text.equation,
                          figure_number(1e-6 * law.fit.stiffness_per_area_N_per_m3));
  if (law.fit.law != DepthLaw::linear)
    line += fmt::format(", {} = {}", text.shape, figure_number(text.scale * law.fit.shape));
  line += fmt::format("; rms {:.2f} N.", law.fit.rms_N);
  if (fit.held_out_trials > 0)
    line += fmt::format(" On {} held-out presses: rms {:.2f} N; error {} at 5, {} at 10, {} at 20 mm.",
                        fit.held_out_trials, law.heldout_rms_N, percent(law.relative_error[0]),
                        percent(law.relative_error[1]), percent(law.relative_error[2]));
  return line;
}

// The law in words; its equation and values are in the lines and on the page.
std::string answer_of(const IntrusionFit& fit) {
  if (!fit.chosen) return line_of(fit);
  const auto& law = fit.laws[*fit.chosen];
  auto answer = fmt::format("Of {} depth laws the {} law fits best", fit.laws.size(), title_of(law.fit.law));
  if (fit.held_out_trials > 0)
    answer +=
        fmt::format("; at {:.0f} mm its prediction of the {} held-out presses is off by {} on average",
                    1e3 * kPredictedDepths_m.back(), fit.held_out_trials, percent(law.relative_error.back()));
  return answer + ".";
}

}  // namespace

CampaignConclusions tell_presses(const IntrusionFit& fit, std::span<const PressTrial> trials) {
  CampaignConclusions out;
  out.answer = answer_of(fit);
  out.lines.push_back(line_of(fit));
  out.json = json_of(fit);
  StudySection section{.title = "Plates pressed into the bed"};
  section.items.emplace_back(
      fmt::format("Fitted on {} {}, {} held out. Every law says how the force grows with depth and, by "
                  "that, with the "
                  "plate's size; one size alone cannot tell how force grows with area, so what is predicted "
                  "for another size "
                  "rests on the law.",
                  fit.fit_trials, fit.fit_trials == 1 ? "trial" : "trials", fit.held_out_trials));
  if (fit.chosen) section.items.emplace_back(force_figure(fit, trials));
  section.items.emplace_back(law_table(fit));
  if (fit.held_out_trials > 0) {
    section.items.emplace_back(prediction_table(fit));
    if (fit.chosen) {
      section.items.emplace_back(trial_table(fit.laws[*fit.chosen]));
      section.items.emplace_back(prediction_text(fit));
    }
  }
  if (!fit.area.empty()) section.items.emplace_back(area_text(fit.area));
  section.items.emplace_back(rig_text(fit.rig));
  section.items.emplace_back(rig_figure(trials));
  section.items.emplace_back(std::string(
      "Not explained: how the strength differs from trial to trial; the first millimetres, where the plate's "
      "tilt and the "
      "height "
      "of the surface matter; whether a stiffening with depth is the floor below, the walls, or sand that "
      "compacts on the way. Only another depth of bed, or a third size of plate, would tell these apart."));
  out.sections.push_back(std::move(section));
  return out;
}

}  // namespace sandhopper
