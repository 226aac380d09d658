#include "tools/report/report_json.hpp"

#include <algorithm>
#include <cmath>

#include "tools/report/base64.hpp"
#include "tools/report/ground_text.hpp"

namespace sandhopper {
namespace {

using Json = nlohmann::json;

// JSON has no NaN; the page reads null as "no value".
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json stiffness(const ReportStiffness& fit) {
  return {{"value_N_per_m", number(fit.value_N_per_m)},
          {"ci95_N_per_m", {number(fit.ci95_low_N_per_m), number(fit.ci95_high_N_per_m)}},
          {"intercept_N", number(fit.intercept_N)},
          {"samples", fit.samples},
          {"valid", fit.valid},
          {"reason", fit.reason}};
}

// Force at the profile's points with its 95 % band, the range of depths visited, and the shape of the ground.
Json profile_json(const StrengthProfile& profile, const GroundSummary& ground) {
  if (profile.stride == 0) return nullptr;
  Json depth = Json::array(), force = Json::array(), low = Json::array(), high = Json::array();
  for (std::size_t i = 0; i < kProfilePoints; ++i) {
    const ProfilePoint point{profile.force_N[i], profile.force_sd_N[i]};
    depth.push_back(static_cast<double>(i + 1) * kProfilePoint_m);
    force.push_back(number(point.value));
    low.push_back(number(point.low()));
    high.push_back(number(point.high()));
  }
  return {{"from_m", profile.depth_min_m},
          {"to_m", profile.depth_max_m},
          {"depth_m", depth},
          {"force_N", force},
          {"low_N", low},
          {"high_N", high},
          {"shape", name_of(ground.shape)}};
}

Json stride_json(const ReportStride& stride) {
  return {{"number", stride.number},
          {"contact_s", number(stride.contact_s)},
          {"touchdown_s", number(stride.touchdown_s)},
          {"switch_s", number(stride.switch_s)},
          {"liftoff_s", number(stride.liftoff_s)},
          {"touchdown_speed_mps", number(stride.touchdown_speed_mps)},
          {"peak_force_N", number(stride.peak_force_N)},
          {"max_depth_m", number(stride.max_depth_m)},
          {"qs_ols", stiffness(stride.quasi_static_ols)},
          {"mo_ols", stiffness(stride.observer_ols)},
          {"mo_wls", stiffness(stride.observer_wls)},
          {"joint", stiffness(stride.joint)},
          {"profile", profile_json(stride.profile, stride.ground)}};
}

Json columns_json(const std::vector<ReportColumn>& columns) {
  Json result = Json::object();
  for (const ReportColumn& column : columns) {
    const std::vector<float> values(column.values.begin(), column.values.end());
    result[column.name] = base64_numbers<float>(values);
  }
  return result;
}

// The events of the firmware, and at each liftoff the events that the stance found in the ground.
std::vector<ReportEvent> with_ground_events(const ReportData& data) {
  auto events = data.events;
  for (const ReportStride& stride : data.strides)
    for (const auto* found : found_in(stride.ground_events))
      events.push_back({stride.liftoff_s, stride.number, "ground", "found in the stance", in_words(*found)});
  std::ranges::stable_sort(events, {}, &ReportEvent::time_s);
  return events;
}

}  // namespace

nlohmann::json report_json(const ReportData& data, std::size_t envelope_run) {
  Json json{{"title", data.title},
            {"facts", data.facts},
            {"notes", data.notes},
            {"time_s", base64_numbers<double>(data.time_s)},
            {"columns", columns_json(data.columns)},
            {"envelope_rows", envelope_run},
            {"configuration", data.configuration}};
  json["bed_curve"] = data.bed_depth_m.empty()
                          ? Json(nullptr)
                          : Json{{"depth_m", data.bed_depth_m}, {"force_N", data.bed_force_N}};
  json["phases"] = Json::array();
  for (const ReportPhase& phase : data.phases) {
    json["phases"].push_back({{"from_s", phase.from_s}, {"to_s", phase.to_s}, {"name", phase.name}});
  }
  json["events"] = Json::array();
  for (const ReportEvent& event : with_ground_events(data)) {
    json["events"].push_back({{"time_s", event.time_s},
                              {"stride", event.stride},
                              {"name", event.name},
                              {"reason", event.reason},
                              {"values", event.values}});
  }
  json["answer"] = trial_line(data);
  json["strides"] = Json::array();
  for (const ReportStride& stride : data.strides) json["strides"].push_back(stride_json(stride));
  return json;
}

std::string page_text(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace sandhopper
