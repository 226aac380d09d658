#include <fmt/format.h>

#include <cmath>

#include "tools/terrain/figure_text.hpp"
#include "tools/terrain/leg_force_trials.hpp"

namespace sandhopper {
namespace {

using Json = nlohmann::ordered_json;

struct FormText {
  const char* key;
  const char* title;
  const char* color;
};
constexpr std::array<FormText, kLegForceForms> kForms{
    FormText{"quasi_static", "quasi-static, τ/L'", "orange"},
    FormText{"joint_row_smooth", "identified, offline", "blue"},
    FormText{"joint_row_observer", "identified, observer (causal)", "green"},
    FormText{"reduced_row", "identified, reduced equation with the body's mass (causal)", "purple"}};
constexpr std::array<const char*, kLegWindows> kWindows{"settled", "contact", "controller"};

struct ParameterText {
  const char* key;
  const char* title;
  double scale;
  const char* unit;
};
constexpr std::array<ParameterText, kLegParameters> kParameters{
    ParameterText{"torque_scale", "scale of the commanded torque, s", 1.0, ""},
    ParameterText{"rotor_inertia_kg_m2", "inertia at the joint besides the body, J", 1e3, "g m²"},
    ParameterText{"joint_coulomb_Nm", "Coulomb friction of the joint, c", 1.0, "N m"},
    ParameterText{"joint_viscous_Nm_s", "viscous friction of the joint, b", 1.0, "N m s"},
    ParameterText{"clock_offset_s", "plate's clock behind the motors', d", 1e3, "ms"}};

std::string newtons(double value) { return std::isnan(value) ? "–" : fmt::format("{:.2f}", value); }

StudyTable errors_table(const LegIdentification& leg) {
  StudyTable table{
      .title = "Root mean square error against the plate, N",
      .columns = {"estimate", "settled, fit", "settled, held out", "contact, fit", "contact, held out",
                  "controller's stance, fit", "controller's stance, held out"}};
  for (std::size_t f = 0; f < kLegForceForms; ++f) {
    std::vector<std::string> row{kForms[f].title};
    for (std::size_t w = 0; w < kLegWindows; ++w)
      for (const bool held_out : {false, true})
        row.push_back(newtons(leg.rms_N(static_cast<LegForceForm>(f), static_cast<LegWindow>(w), held_out)));
    table.rows.push_back(std::move(row));
  }
  table.note = fmt::format(
      "Settled: from the set-up's contact_settling_s after the landing to the controller's liftoff. Contact: "
      "from the landing on, with the blow and the ringing of the plate, which no motor feels. Controller's "
      "stance: with the time in the air between its touchdown and the landing. The observer's own delay of "
      "{:.0f} ms is most of its error: against the plate seen through the same lag it is off by {} N (held "
      "out, settled). The offline estimate looks {:.0f} ms ahead.",
      1e3 / leg.observer_gain_per_s, newtons(leg.observer_without_delay_N(true)), 1e3 * leg.half_width_s);
  return table;
}

double least_left_out(const LegIdentification& leg) {
  double least = std::nan("");
  for (const auto& [half_width_s, rms_N] : leg.cross_validation_N)
    if (!(least <= rms_N)) least = rms_N;
  return least;
}

StudyTable parameter_table(const LegIdentification& leg) {
  StudyTable table{.title = "Identified figures",
                   .columns = {"figure", "unit", "value", "95 % interval"},
                   .text_columns = 2};
  for (std::size_t i = 0; i < kLegParameters; ++i) {
    const auto& p = kParameters[i];
    table.rows.push_back(
        {p.title, p.unit,
         value_text(p.scale * leg.value[i], p.scale * leg.interval[i].ci95_low,
                    p.scale * leg.interval[i].ci95_high),
         interval_text(p.scale * leg.interval[i].ci95_low, p.scale * leg.interval[i].ci95_high)});
  }
  if (leg.has_spring)
    table.rows.push_back(
        {"spring beside the motor, k", "N m/rad",
         value_text(leg.spring_stiffness_Nm_per_rad, leg.spring_stiffness_interval.ci95_low,
                    leg.spring_stiffness_interval.ci95_high),
         interval_text(leg.spring_stiffness_interval.ci95_low, leg.spring_stiffness_interval.ci95_high)});
  table.rows.push_back({"mass, from the plate's impulse over a cycle", "kg",
                        value_text(leg.mass_kg.value, leg.mass_kg.ci95_low, leg.mass_kg.ci95_high),
                        interval_text(leg.mass_kg.ci95_low, leg.mass_kg.ci95_high)});
  table.rows.push_back({"plate's reading in flight, taken off", "N", figure_number(leg.tare_N), "–"});
  table.note = fmt::format(
      "Intervals: bootstrap with whole hops drawn; mass: Student's t over hops. A foot's weight in addition "
      "would be fitted as {} kg ({}), which torque scale and friction can stand in for: not told apart, not "
      "used. A spring beside the motor is {}: hops left out are {} N off with it, {} N without.",
      value_text(leg.foot_mass_kg, leg.foot_mass_interval.ci95_low, leg.foot_mass_interval.ci95_high),
      interval_text(leg.foot_mass_interval.ci95_low, leg.foot_mass_interval.ci95_high),
      leg.has_spring ? "taken in" : "not needed", newtons(leg.with_spring_N), newtons(least_left_out(leg)));
  return table;
}

const LegHopFit* drawn_hop(const LegIdentification& leg) {
  const LegHopFit* drawn = nullptr;
  for (const auto& hop : leg.hops)
    if (drawn == nullptr || (hop.held_out && !drawn->held_out)) drawn = &hop;
  return drawn;
}

StudyFigure force_figure(const LegHopFit& hop) {
  StudyFigure figure{.title = fmt::format("Contact force in {}{}", trial_label(hop.trial),
                                          hop.held_out ? " (held out)" : ""),
                     .x_label = "time, s",
                     .y_label = "force, N",
                     .wide = true};
  auto plate = hop.reference_N;
  for (double& force : plate)
    if (std::abs(force) > 80.0) force = std::nan("");
  figure.series.push_back(
      {.label = "force plate", .x = hop.t_s, .y = plate, .mark = StudySeries::Mark::line, .color = "text"});
  for (std::size_t f = 0; f < kLegForceForms; ++f) {
    auto force = hop.force_N[f];
    for (double& value : force)
      if (std::abs(value) > 80.0) value = std::nan("");
    figure.series.push_back({.label = kForms[f].title,
                             .x = hop.t_s,
                             .y = std::move(force),
                             .mark = StudySeries::Mark::line,
                             .color = kForms[f].color,
                             .shown = f != 3});
  }
  figure.note = fmt::format("Landing at {:.3f} s; forces beyond 80 N (the blow) are left out of the drawing.",
                            hop.landing_s);
  return figure;
}

StudyFigure residual_figure(const LegIdentification& leg) {
  StudyFigure figure{.title = "Residual of the offline estimate, held-out hops",
                     .x_label = "joint rate, rad/s",
                     .y_label = "estimate − plate, N"};
  constexpr std::array kColors{"blue", "orange", "green", "purple", "sand", "grey"};
  for (const auto& hop : leg.hops) {
    if (!hop.held_out || figure.series.size() >= kColors.size()) continue;
    StudySeries series{
        .label = trial_label(hop.trial), .x = {}, .y = {}, .color = kColors[figure.series.size()]};
    for (std::size_t row = 0; row < hop.t_s.size(); ++row)
      if (hop.settled[row]) {
        series.x.push_back(hop.rate_radps[row]);
        series.y.push_back(hop.force_N[1][row] - hop.reference_N[row]);
      }
    figure.series.push_back(std::move(series));
  }
  figure.note =
      "Compression on the right, extension on the left. The waves are the plate's and the leg's own "
      "vibration; "
      "a step at zero would be friction of the wrong size.";
  return figure;
}

StudyFigure choice_figure(const LegIdentification& leg) {
  StudyFigure figure{
      .title = "Choices", .x_label = "half width or time left out, s", .y_label = "rms error, N"};
  StudySeries width{.label = "smoothing half width: fit hops, each left out in turn",
                    .x = {},
                    .y = {},
                    .mark = StudySeries::Mark::line_and_points,
                    .color = "blue"};
  for (const auto& [half_width_s, rms_N] : leg.cross_validation_N) {
    width.x.push_back(half_width_s);
    width.y.push_back(rms_N);
  }
  StudySeries settling{.label = "time after the landing that is left out: held-out hops",
                       .x = {},
                       .y = {},
                       .mark = StudySeries::Mark::line_and_points,
                       .color = "orange"};
  for (const auto& [settling_s, rms_N] : leg.settling_rms_N) {
    settling.x.push_back(settling_s);
    settling.y.push_back(rms_N);
  }
  figure.series = {std::move(width), std::move(settling)};
  figure.note = "The half width was chosen on the fit hops; the settling time is part of the set-up.";
  return figure;
}

Json parameters_json(const LegIdentification& leg) {
  Json json = Json::object();
  for (std::size_t i = 0; i < kLegParameters; ++i)
    json[kParameters[i].key] = {{"value", leg.value[i]},
                                {"ci95", {leg.interval[i].ci95_low, leg.interval[i].ci95_high}}};
  json["mass_kg"] = {{"value", leg.mass_kg.value}, {"ci95", {leg.mass_kg.ci95_low, leg.mass_kg.ci95_high}}};
  if (leg.has_spring)
    json["spring_Nm_per_rad"] = {
        {"value", leg.spring_stiffness_Nm_per_rad},
        {"ci95", {leg.spring_stiffness_interval.ci95_low, leg.spring_stiffness_interval.ci95_high}}};
  json["plate_tare_N"] = leg.tare_N;
  return json;
}

Json errors_json(const LegIdentification& leg) {
  Json json = Json::object();
  const auto number = [](double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); };
  for (std::size_t f = 0; f < kLegForceForms; ++f)
    for (std::size_t w = 0; w < kLegWindows; ++w)
      for (const bool held_out : {false, true})
        json[kForms[f].key][kWindows[w]][held_out ? "held_out" : "fit"] =
            number(leg.rms_N(static_cast<LegForceForm>(f), static_cast<LegWindow>(w), held_out));
  return json;
}

}  // namespace

CampaignConclusions tell_leg(const LegIdentification& leg, const RigidGround& ground) {
  CampaignConclusions out;
  const bool tested = leg.held_out_hops > 0;
  const auto rms = [&](LegForceForm form) { return leg.rms_N(form, LegWindow::settled, tested); };
  out.answer = rigid_answer(ground);
  out.lines.push_back(out.answer);
  out.lines.push_back(
      fmt::format("Leg's force against the plate, {} hops fitted, {} held out: rms {} N quasi-static, {} N "
                  "with the leg's "
                  "inertia and friction (offline), {} N as observer ({}, settled stance).",
                  leg.fit_hops, leg.held_out_hops, newtons(rms(LegForceForm::quasi_static)),
                  newtons(rms(LegForceForm::joint_row_smooth)),
                  newtons(rms(LegForceForm::joint_row_observer)), tested ? "held out" : "fit"));
  out.json = {{"fit_hops", leg.fit_hops},
              {"held_out_hops", leg.held_out_hops},
              {"parameters", parameters_json(leg)},
              {"rms_error_N", errors_json(leg)},
              {"smoothing_half_width_s", leg.half_width_s},
              {"observer_gain_per_s", leg.observer_gain_per_s},
              {"ground", rigid_json(ground)}};
  StudySection rigid{.title = "Stiffness of the ground"};
  rigid.items.emplace_back(out.answer);
  rigid.items.emplace_back(rigid_table(ground));
  out.sections.push_back(std::move(rigid));
  StudySection section{.title = "The leg's force estimate against the force plate"};
  section.items.emplace_back(fmt::format(
      "Fitted on {} hops: four figures of the joint and the offset between the clocks, with the foot at "
      "rest: "
      "F(t + d) = [s τ − J φ̈ − c tanh(φ̇/0.2) − b φ̇] / L'. Smoothing and the observer's gain were chosen on "
      "the same hops, each left out in turn. {} hops were held out and counted once.",
      leg.fit_hops, leg.held_out_hops));
  section.items.emplace_back(errors_table(leg));
  if (const auto* hop = drawn_hop(leg)) section.items.emplace_back(force_figure(*hop));
  section.items.emplace_back(parameter_table(leg));
  if (tested) section.items.emplace_back(residual_figure(leg));
  section.items.emplace_back(choice_figure(leg));
  section.items.emplace_back(fmt::format(
      "Not explained: the blow of the landing and the ringing of the plate after it, which the angle does "
      "not "
      "show; vibration of leg and plate in mid-stance; friction that depends on the load; and the plate's "
      "gain, "
      "which is not told apart from the torque's scale. The mass believed is {} kg, by the plate's "
      "impulse it "
      "is {} kg: if the belief is right, the plate reads {} times the force.",
      figure_number(leg.believed_mass_kg), figure_number(leg.mass_kg.value),
      figure_number(leg.mass_kg.value / leg.believed_mass_kg)));
  out.sections.push_back(std::move(section));
  return out;
}

}  // namespace sandhopper
