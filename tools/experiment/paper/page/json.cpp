#include <cmath>
#include <nlohmann/json.hpp>

#include "tools/experiment/paper/report.hpp"
#include "tools/experiment/paper/summaries.hpp"
#include "tools/report/study_text.hpp"

namespace sandhopper::paper {
namespace {

using Json = nlohmann::ordered_json;

Json claim_json(const Claim& claim) {
  Json json{{"number", claim.number},
            {"statement", without_marks(claim.statement)},
            {"pass_line", without_marks(claim.pass_line)},
            {"figures", Json::array()},
            {"verdict", std::string(words(claim.verdict))},
            {"why", without_marks(claim.why)}};
  for (const auto& figure : claim.figures) {
    json["figures"].push_back(
        {{"name", without_marks(figure.name)}, {"value", figure.value}, {"unit", figure.unit}});
    if (std::isnan(figure.lowest)) continue;
    json["figures"].back()["smallest"] = figure.lowest;
    json["figures"].back()["largest"] = figure.highest;
  }
  return json;
}

Json map_json(const ForceMap& map) {
  const auto& [a, b, c] = map.drag_coefficient;
  return {{"intercept_N", map.intercept_N},
          {"stiffness_N_per_m", map.stiffness_N_per_m},
          {"drag_kg_per_m", a},
          {"drag_kg_per_m2", b},
          {"drag_kg_per_m3", c},
          {"r_squared", map.r_squared},
          {"rms_N", map.rms_N},
          {"samples", map.samples}};
}

Json treatments_json(const std::array<double, kTreatments>& error) {
  return {{"qs_ols", error[0]}, {"mo_ols", error[1]}, {"mo_wls", error[2]}};
}

Json case_json(const CaseResult& result) {
  Json cells = Json::array();
  for (std::size_t cell = 0; cell < hop_cells().size(); ++cell) {
    std::array<double, kTreatments> sum{};
    double seeds = 0.0;
    for (const auto& seed : result.ratio) {
      if (!std::isfinite(seed[cell][0])) continue;
      for (std::size_t t = 0; t < kTreatments; ++t) sum[t] += seed[cell][t];
      seeds += 1.0;
    }
    for (auto& value : sum) value /= seeds;
    cells.push_back({{"touchdown_speed_mps", hop_cells()[cell].touchdown_speed_mps},
                     {"compression_stiffness_N_per_m", hop_cells()[cell].compression_stiffness_N_per_m},
                     {"mean_ratio", treatments_json(sum)}});
  }
  return {{"case", std::string(result.definition.name)},
          {"mean_error", treatments_json(result.mean_error())},
          {"seeds", result.error_by_seed.size()},
          {"seeds_qs_over_mo", result.seeds_in_order(Treatment::quasi_static_ols, Treatment::observer_ols)},
          {"seeds_mo_over_wls", result.seeds_in_order(Treatment::observer_ols, Treatment::observer_wls)},
          {"cells", cells}};
}

Json decomposition_json(const std::vector<SpeedDecomposition>& rows) {
  Json json = Json::array();
  for (const auto& d : rows)
    json.push_back({{"touchdown_speed_mps", d.speed_mps},
                    {"line_rms_N", d.line_N},
                    {"map_rms_N", d.map_N},
                    {"map_and_added_mass_rms_N", d.inertial_N},
                    {"falls_by_percent", d.drop_percent()},
                    {"correlation", d.correlation}});
  return json;
}

Json errors_json(const std::vector<SpeedErrors>& rows) {
  Json json = Json::array();
  for (const auto& [speed_mps, e] : rows)
    json.push_back({{"touchdown_speed_mps", speed_mps},
                    {"quasi_static_rms_N", e.quasi_static_N.rms()},
                    {"observer_rms_N", e.observer_N.rms()},
                    {"load_cell_rms_N", e.load_cell_N.rms()},
                    {"observer_to_load_cell_rms_N", e.observer_to_cell_N.rms()},
                    {"depth_to_motion_capture_rms_m", e.foot_depth_m.rms()},
                    {"depth_about_trial_mean_rms_m", e.depth_about_trial_mean_m.rms()},
                    {"foot_velocity_rms_mps", e.foot_velocity_mps.rms()},
                    {"body_velocity_rms_mps", e.body_velocity_mps.rms()}});
  return json;
}

}  // namespace

Json programme_json(const ProgrammeResults& r, const std::vector<Claim>& claims) {
  Json json;
  json["claims"] = Json::array();
  for (const auto& claim : claims) json["claims"].push_back(claim_json(claim));
  json["stiffness_N_per_m"] = {{"bed", r.stiffness.bed},
                               {"slow_free_intercept", r.stiffness.slow_free_intercept},
                               {"slow_through_origin", r.stiffness.slow_through_origin},
                               {"map_coefficient", r.stiffness.map_coefficient},
                               {"all_runs_free_intercept", r.stiffness.all_runs_free_intercept},
                               {"fastest_free_intercept", r.stiffness.fastest_free_intercept}};
  json["map"] = map_json(r.map);
  json["map_with_amplifier_lag"] = map_json(r.map_with_lag);
  json["decomposition"] = {
      {"truth", decomposition_json(decomposition_by_speed(r, &HopResult::truth))},
      {"load_cell", decomposition_json(decomposition_by_speed(r, &HopResult::instruments))},
      {"robot", decomposition_json(decomposition_by_speed(r, &HopResult::robot))}};
  json["estimation"] = errors_json(errors_by_speed(r));
  json["treatments"] = Json::array();
  for (const auto& one : r.treatments.cases) json["treatments"].push_back(case_json(one));
  json["treatments_with_ages_ignored"] = Json::array();
  for (const auto& one : r.without_ages.cases) json["treatments_with_ages_ignored"].push_back(case_json(one));
  json["conditions"] = Json::array();
  for (const auto& c : r.conditions)
    json["conditions"].push_back({{"name", c.name},
                                  {"case_A", treatments_json(c.penetrating)},
                                  {"case_B", treatments_json(c.to_max_depth)},
                                  {"seeds", c.seeds},
                                  {"seeds_weighted_better", c.seeds_weighted_better},
                                  {"strides", c.strides},
                                  {"incomplete", c.incomplete}});
  return json;
}

}  // namespace sandhopper::paper
