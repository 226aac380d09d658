#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/terrain/figure_text.hpp"
#include "tools/terrain/mean_json.hpp"
#include "tools/terrain/penetrometer_trials.hpp"

namespace sandhopper {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array kColors{"blue", "orange", "green", "purple", "sand", "grey"};
const char* color_of(std::size_t i) { return kColors[i % kColors.size()]; }

Json value_json(const TrialMean& mean) {
  return {{"value", number_or_null(mean.value)},
          {"ci95", {number_or_null(mean.ci95_low), number_or_null(mean.ci95_high)}}};
}

std::string title_of(ResistanceLaw law) {
  switch (law) {
    case ResistanceLaw::depth:
      return "k z";
    case ResistanceLaw::depth_power:
      return "k z^n";
    case ResistanceLaw::depth_power_rate:
      return "k z^n v^b";
    case ResistanceLaw::depth_power_square:
      return "k (z^n + b v²)";
    case ResistanceLaw::speed_square:
      return "k v²";
  }
  return "";
}

FluidCoefficients with_mass(const PenetrometerDrop& drop, double mass_kg) {
  auto body = drop.body;
  body.mass_kg = mass_kg;
  return coefficients(drop.fluid, body);
}

std::string range(double low, double high) {
  return fmt::format("{:.3g} to {:.3g}", std::min(low, high), std::max(low, high));
}

double greatest_resistance(const PenetrometerDrop& drop) {
  double greatest = 0.0;
  for (const auto& sample : drop.penetration) greatest = std::max(greatest, sample.resistance);
  return greatest;
}

StudyTable drop_table(const std::vector<PenetrometerDrop>& drops) {
  StudyTable table{
      .title = "Drops",
      .columns = {"drop", "speed at touchdown, m/s", "depth, mm", "greatest resistance per mass, m/s²",
                  "greatest resistance, N", "speed before the release, m/s", "fall height, m",
                  "fall height by pressure, m"}};
  for (const auto& drop : drops) {
    const auto low = with_mass(drop, drop.mass_min_kg), high = with_mass(drop, drop.mass_max_kg);
    const double greatest = greatest_resistance(drop);
    table.rows.push_back(
        {trial_label(drop.trial), fmt::format("{:.2f}", drop.impact_speed_mps),
         fmt::format("{:.0f}", 1e3 * drop.depth_m), fmt::format("{:.1f}", greatest),
         range(low.moving_mass_kg * greatest, high.moving_mass_kg * greatest),
         fmt::format("{:+.3f}", drop.speed_before_release_mps), fmt::format("{:.2f}", drop.fallen_m),
         std::isnan(drop.fallen_by_pressure_m) ? "–" : fmt::format("{:.2f}", drop.fallen_by_pressure_m)});
  }
  table.note =
      "Speed is integrated back from the rest after the impact, where it is zero and the accelerometer's "
      "bias is "
      "known. The body hung at rest before the release: the speed that the integral gives there is its "
      "error. "
      "Forces for both ends of the range of the mass. The height by pressure is only a check: "
      "its sensor lags, and the bed has a pressure of its own.";
  return table;
}

StudyTable fluid_table(const std::vector<PenetrometerDrop>& drops) {
  StudyTable table{.title = "The fall through the water",
                   .columns = {"drop", "α", "κ, 1/m", "rms, m/s²", "moving mass, kg", "C_m", "C_d"}};
  for (const auto& drop : drops) {
    const auto low = with_mass(drop, drop.mass_min_kg), high = with_mass(drop, drop.mass_max_kg);
    table.rows.push_back(
        {trial_label(drop.trial), fmt::format("{:.3f}", drop.fluid.alpha),
         fmt::format("{:.3f}", drop.fluid.kappa_per_m), fmt::format("{:.2f}", drop.fluid.rms_mps2),
         range(low.moving_mass_kg, high.moving_mass_kg), range(low.added_mass_factor, high.added_mass_factor),
         range(low.drag_coefficient, high.drag_coefficient)});
  }
  table.note =
      "v' = α g − κ v². The fall tells α and κ; moving mass, added-mass and drag coefficients follow for "
      "each "
      "end of the range of the mass. The drag of the line it falls with is in κ.";
  return table;
}

StudyTable sensor_table(const std::vector<PenetrometerDrop>& drops) {
  StudyTable table{.title = "Accelerometers",
                   .columns = {"drop", "channel", "scale", "bias, m/s²", "noise, m/s²", "greatest, m/s²",
                               "saturated samples"},
                   .text_columns = 2};
  for (const auto& drop : drops)
    for (std::size_t i = 0; i < drop.fused.calibration.size(); ++i) {
      const auto& c = drop.fused.calibration[i];
      table.rows.push_back({trial_label(drop.trial),
                            drop.names[i] + (i == drop.fused.reference ? " (reference)" : ""),
                            fmt::format("{:.4f}", c.scale), fmt::format("{:+.3f}", c.bias_mps2),
                            fmt::format("{:.3f}", c.noise_mps2), fmt::format("{:.1f}", c.saturation_mps2),
                            fmt::format("{}", c.saturated_samples)});
    }
  table.note =
      "Scale and bias are relative to the reference: the least noisy accelerometer that never saturates. At "
      "each instant the least noisy one is used that is neither saturated nor off. The drop cannot show the "
      "scale of the reference itself.";
  return table;
}

StudyTable law_table(const PenetrometerFit& fit) {
  StudyTable table{.title = "Resistance against depth z and speed v",
                   .columns = {"equation", "n", "n, 95 % interval", "b", "b, 95 % interval", "rms, m/s²",
                               "left out, share of the greatest"}};
  for (std::size_t i = 0; i < fit.laws.size(); ++i) {
    const auto& law = fit.laws[i];
    const bool n = law.fit.law != ResistanceLaw::depth && law.fit.law != ResistanceLaw::speed_square;
    const bool b =
        law.fit.law == ResistanceLaw::depth_power_rate || law.fit.law == ResistanceLaw::depth_power_square;
    table.rows.push_back(
        {title_of(law.fit.law) + (i == fit.chosen ? " (chosen)" : ""),
         n ? value_text(law.fit.exponent, law.exponent.ci95_low, law.exponent.ci95_high) : "–",
         n ? interval_text(law.exponent.ci95_low, law.exponent.ci95_high) : "–",
         b ? value_text(law.fit.rate, law.rate.ci95_low, law.rate.ci95_high) : "–",
         b ? interval_text(law.rate.ci95_low, law.rate.ci95_high) : "–", figure_number(law.fit.rms),
         std::isnan(law.cross_validation) ? "–" : fmt::format("{:.1f} %", 100.0 * law.cross_validation)});
  }
  table.note =
      "Resistance per moving mass, beyond buoyancy and the water's drag; k is each drop's own. Intervals: "
      "drops "
      "fitted one by one, Student's t. Left out: shape from the other drops, k from the drop itself.";
  return table;
}

StudyFigure resistance_figure(const PenetrometerFit& fit, const std::vector<PenetrometerDrop>& drops) {
  StudyFigure figure{.title = "Resistance against depth",
                     .x_label = "depth, mm",
                     .y_label = "resistance per moving mass, m/s²",
                     .wide = true};
  const auto& law = fit.laws[fit.chosen].fit;
  for (std::size_t i = 0; i < drops.size(); ++i) {
    StudySeries measured{.label = trial_label(drops[i].trial), .x = {}, .y = {}, .color = color_of(i)};
    StudySeries fitted{.label = trial_label(drops[i].trial) + ", law",
                       .x = {},
                       .y = {},
                       .mark = StudySeries::Mark::line,
                       .color = color_of(i),
                       .dashed = true};
    for (const auto& sample : drops[i].penetration) {
      measured.x.push_back(1e3 * sample.depth_m);
      measured.y.push_back(sample.resistance);
      fitted.x.push_back(1e3 * sample.depth_m);
      fitted.y.push_back(
          resistance(law.law, law.exponent, law.rate, law.strength[i], sample.depth_m, sample.speed_mps));
    }
    figure.series.push_back(std::move(measured));
    figure.series.push_back(std::move(fitted));
  }
  figure.note = fmt::format(
      "Dashed: the chosen law, {}. All drops share its exponents; each has a strength k of its own.",
      title_of(law.law));
  return figure;
}

StudyFigure speed_figure(const std::vector<PenetrometerDrop>& drops) {
  StudyFigure figure{.title = "Speed against depth", .x_label = "depth, mm", .y_label = "speed, m/s"};
  for (std::size_t i = 0; i < drops.size(); ++i) {
    StudySeries series{.label = trial_label(drops[i].trial),
                       .x = {},
                       .y = {},
                       .mark = StudySeries::Mark::line,
                       .color = color_of(i)};
    for (const auto& sample : drops[i].penetration) {
      series.x.push_back(1e3 * sample.depth_m);
      series.y.push_back(sample.speed_mps);
    }
    figure.series.push_back(std::move(series));
  }
  return figure;
}

StudyFigure impact_figure(const std::vector<PenetrometerDrop>& drops) {
  StudyFigure figure{.title = "Specific force about the impact",
                     .x_label = "time from touchdown, s",
                     .y_label = "specific force, m/s²"};
  for (std::size_t i = 0; i < drops.size(); ++i)
    figure.series.push_back({.label = trial_label(drops[i].trial),
                             .x = drops[i].t_s,
                             .y = drops[i].specific_force_mps2,
                             .mark = StudySeries::Mark::line,
                             .color = color_of(i)});
  figure.note = "Of all accelerometers together, bias taken off.";
  return figure;
}

std::string untold(const PenetrometerFit& fit, const std::vector<PenetrometerDrop>& drops) {
  std::string correlations;
  for (const double c : fit.depth_speed_correlation)
    correlations += fmt::format("{}{:.2f}", correlations.empty() ? "" : ", ", c);
  const auto& drop = drops.front();
  return fmt::format(
      "These drops cannot tell: (1) the force in newtons better than the mass is known, {:.3g} to {:.3g} kg; "
      "(2) in one drop, depth from speed, because the speed falls while the depth grows (correlation of ln z "
      "and "
      "ln v: {}), so a larger exponent of depth looks like a smaller exponent of speed; (3) a bed whose kind "
      "changes with depth from one whose strength grows with depth: both give the exponent n; (4) the added "
      "mass "
      "of the bed, which changes the same curve. If touchdown is gradual, zero depth is uncertain by a "
      "centimetre or two. Not explained: sharp peaks from hard inclusions or layers, which no smooth law "
      "has.",
      drop.mass_min_kg, drop.mass_max_kg, correlations);
}

Json json_of(const PenetrometerFit& fit, const std::vector<PenetrometerDrop>& drops) {
  Json json{{"drops", Json::array()}, {"laws", Json::array()}};
  for (const auto& drop : drops) {
    const auto low = with_mass(drop, drop.mass_min_kg), high = with_mass(drop, drop.mass_max_kg);
    json["drops"].push_back(
        {{"trial", drop.trial},
         {"impact_speed_mps", number_or_null(drop.impact_speed_mps)},
         {"depth_m", number_or_null(drop.depth_m)},
         {"alpha", number_or_null(drop.fluid.alpha)},
         {"kappa_per_m", number_or_null(drop.fluid.kappa_per_m)},
         {"moving_mass_kg", {number_or_null(low.moving_mass_kg), number_or_null(high.moving_mass_kg)}},
         {"added_mass_factor",
          {number_or_null(low.added_mass_factor), number_or_null(high.added_mass_factor)}},
         {"drag_coefficient", {number_or_null(low.drag_coefficient), number_or_null(high.drag_coefficient)}},
         {"greatest_resistance_N",
          {number_or_null(low.moving_mass_kg * greatest_resistance(drop)),
           number_or_null(high.moving_mass_kg * greatest_resistance(drop))}},
         {"fallen_m", number_or_null(drop.fallen_m)},
         {"fallen_by_pressure_m", number_or_null(drop.fallen_by_pressure_m)},
         {"speed_while_it_hung_mps", number_or_null(drop.speed_before_release_mps)}});
  }
  for (const auto& law : fit.laws)
    json["laws"].push_back({{"law", name_of(law.fit.law)},
                            {"depth_exponent", law.fit.exponent},
                            {"depth_exponent_by_drop", value_json(law.exponent)},
                            {"rate_exponent", law.fit.rate},
                            {"rate_exponent_by_drop", value_json(law.rate)},
                            {"strength_mps2", law.fit.strength},
                            {"rms_mps2", law.fit.rms},
                            {"leave_one_drop_out", number_or_null(law.cross_validation)}});
  json["chosen"] = name_of(fit.laws[fit.chosen].fit.law);
  return json;
}

}  // namespace

CampaignConclusions tell_penetrations(const PenetrometerFit& fit,
                                      const std::vector<PenetrometerDrop>& drops) {
  CampaignConclusions out;
  const auto& law = fit.laws[fit.chosen];
  out.lines.push_back(
      fmt::format("Resistance of the bed over {} {}: {} with n = {:.2f}, b = {:.2f}; {}.", drops.size(),
                  drops.size() == 1 ? "drop" : "drops", title_of(law.fit.law), law.fit.exponent, law.fit.rate,
                  drops.size() == 1 ? std::string("fitted, not tested on another")
                                    : fmt::format("exponents fitted on the other drops predict a drop with "
                                                  "an error of {:.1f} % of its greatest resistance",
                                                  100.0 * law.cross_validation)));
  out.json = json_of(fit, drops);
  StudySection section{.title = "Penetration into the bed"};
  section.items.emplace_back(
      fmt::format("{} drops, each predicted from the shape that the others give. Resistance is what slows "
                  "the body beyond "
                  "buoyancy, added mass and drag of the water, both found in its fall before touchdown: r = "
                  "ḧ + α g − κ v².",
                  drops.size()));
  section.items.emplace_back(resistance_figure(fit, drops));
  section.items.emplace_back(law_table(fit));
  section.items.emplace_back(speed_figure(drops));
  section.items.emplace_back(impact_figure(drops));
  section.items.emplace_back(drop_table(drops));
  section.items.emplace_back(fluid_table(drops));
  section.items.emplace_back(sensor_table(drops));
  section.items.emplace_back(untold(fit, drops));
  out.sections.push_back(std::move(section));
  return out;
}

}  // namespace sandhopper
