#include "tools/trial/trial_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "terrain/joint_fit.hpp"
#include "tools/trial/profile_text.hpp"

namespace sandhopper {
namespace {

struct Named {
  const char* key;
  const char* text;
  ReportStiffness ReportStride::*member;
};
constexpr std::array<Named, 4> kTreatments{{{"qs_ols", "quasi-static, OLS", &ReportStride::quasi_static_ols},
                                            {"mo_ols", "observer, OLS", &ReportStride::observer_ols},
                                            {"mo_wls", "observer, weighted", &ReportStride::observer_wls},
                                            {"joint", "joint fit", &ReportStride::joint}}};

std::string stiffness_line(const char* name, const ReportStiffness& k) {
  if (!std::isfinite(k.value_N_per_m))
    return fmt::format("    {:<24} -                            not valid: {}", name, k.reason);
  return fmt::format("    {:<24} {:6.0f} N/m  [{:6.0f}, {:6.0f}]  {}", name, k.value_N_per_m,
                     k.ci95_low_N_per_m, k.ci95_high_N_per_m, k.valid ? "valid" : "not valid: " + k.reason);
}

}  // namespace

std::string readable(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

std::vector<std::string> stride_lines(const ReportData& data) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < data.strides.size(); ++i) {
    const auto& s = data.strides[i];
    lines.push_back(
        fmt::format("  stride {}: touchdown {:.2f} m/s at {:.3f} s, switch {:.3f} s, liftoff {:.3f} s, peak "
                    "force {:.1f} N, depth {:.1f} mm",
                    s.number, s.touchdown_speed_mps, s.touchdown_s, s.switch_s, s.liftoff_s, s.peak_force_N,
                    1e3 * s.max_depth_m));
    for (const auto& t : kTreatments) lines.push_back(stiffness_line(t.text, s.*t.member));
    for (auto& line : profile_lines(s.profile, s.ground, adds_nothing(data, i)))
      lines.push_back("    " + line);
    for (auto& line : ground_event_lines(s.ground_events)) lines.push_back("    " + line);
  }
  return lines;
}

nlohmann::ordered_json stride_json(const ReportStride& s) {
  nlohmann::ordered_json stiffness = nlohmann::ordered_json::object();
  for (const auto& t : kTreatments) {
    const auto& k = s.*t.member;
    stiffness[t.key] = {{"value", k.value_N_per_m},
                        {"ci95", {k.ci95_low_N_per_m, k.ci95_high_N_per_m}},
                        {"valid", k.valid},
                        {"reason", k.valid ? "" : k.reason},
                        {"samples", k.samples}};
  }
  return {{"stride", s.number},
          {"touchdown_speed_mps", s.touchdown_speed_mps},
          {"touchdown_s", s.touchdown_s},
          {"switch_s", s.switch_s},
          {"liftoff_s", s.liftoff_s},
          {"peak_force_N", s.peak_force_N},
          {"max_depth_m", s.max_depth_m},
          {"stiffness_N_per_m", stiffness},
          {"profile", profile_json(s.profile, s.ground)},
          {"ground_events", ground_events_json(s.ground_events)}};
}

PooledText pooled_text(const std::vector<ReportStride>& strides, const JointConfig& config) {
  std::vector<JointEstimate> estimates;
  for (const auto& stride : strides) {
    JointEstimate e;
    e.value_N_per_m = stride.joint.value_N_per_m;
    e.standard_error_N_per_m = stride.joint.standard_error_N_per_m;
    e.validity = stride.joint.valid ? Validity::valid : Validity::too_few_samples;
    estimates.push_back(e);
  }
  const auto pooled = pool_strides(estimates, config);
  if (pooled.strides < 2) return {};
  const bool holds_zero = pooled.ci95_low_N_per_m <= 0.0;
  return {
      fmt::format(
          "all {} valid strides together: {:.0f} N/m  [{:.0f}, {:.0f}], {:.0f} N/m from stride to stride{}",
          pooled.strides, pooled.value_N_per_m, pooled.ci95_low_N_per_m, pooled.ci95_high_N_per_m,
          pooled.between_strides_sd_N_per_m, holds_zero ? "  not valid: interval includes zero" : ""),
      {{"value", pooled.value_N_per_m},
       {"ci95", {pooled.ci95_low_N_per_m, pooled.ci95_high_N_per_m}},
       {"valid", !holds_zero},
       {"between_strides_sd", pooled.between_strides_sd_N_per_m},
       {"strides", pooled.strides}}};
}

}  // namespace sandhopper
