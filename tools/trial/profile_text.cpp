#include "tools/trial/profile_text.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

#include "tools/report/digits.hpp"

namespace sandhopper {
namespace {

std::string interval(const ProfilePoint& p, int digits) {
  return fmt::format("{:.{}f}  [{:.{}f}, {:.{}f}]", p.value, digits, p.low(), digits, p.high(), digits);
}

// "46400 N/m  [42400, 50700]": no digit is shown that nobody knows.
std::string to_two_digits_of_interval(const SummaryValue& k) {
  const double half = 0.5 * (k.ci95_high - k.ci95_low);
  const auto text = [half](double value) { return digits_by(value, half).value_or(plain_number(value, 3)); };
  return fmt::format("{} N/m  [{}, {}]", text(k.value), text(k.ci95_low), text(k.ci95_high));
}

}  // namespace

std::vector<std::string> profile_lines(const StrengthProfile& p, const GroundSummary& g, bool is_unchanged) {
  if (p.stride == 0) return {};
  std::vector<std::string> lines;
  if (is_unchanged)
    lines.push_back(fmt::format("{:<24} no new ground: as after the stride before", "ground"));
  if (!is_unchanged && p.depth_max_m > 0.0) {
    lines.push_back(fmt::format("{:<24} {}", p.stride > 1 ? "ground, all strides" : "ground", headline(g)));
    lines.push_back(fmt::format("  profile from {:.1f} to {:.1f} mm; deeper it is a guess",
                                1e3 * p.depth_min_m, 1e3 * p.depth_max_m));
  }
  bool first = true;
  for (const double depth_m : {0.010, 0.020, 0.030, 0.040, 0.050}) {
    const bool known = !is_unchanged && depth_m >= p.depth_min_m && depth_m <= p.depth_max_m;
    if (!known) continue;
    if (std::exchange(first, false))
      lines.push_back(
          fmt::format("  {:>5}  {:>20}  {:>20}  {:>20}", "depth", "force, N", "secant, N/m", "tangent, N/m"));
    const auto force = force_at(p, depth_m);
    const ProfilePoint secant{force.value / depth_m, force.sd / depth_m};
    lines.push_back(fmt::format("  {:2.0f} mm  {:>20}  {:>20}  {:>20}", 1e3 * depth_m, interval(force, 1),
                                interval(secant, 0), interval(tangent_at(p, depth_m), 0)));
  }
  const auto& reload = g.reloading_N_per_m;
  if (reload.ci95_low > 0.0)
    lines.push_back(
        std::isfinite(reload.ci95_high)
            ? "  reloading in the crater " + to_two_digits_of_interval(reload)
            : fmt::format("  reloading in the crater at least {} N/m", plain_number(reload.ci95_low, 2)));
  return lines;
}

nlohmann::ordered_json profile_json(const StrengthProfile& p, const GroundSummary& g) {
  if (p.stride == 0) return nullptr;
  using Json = nlohmann::ordered_json;
  Json depth = Json::array(), force = Json::array(), band = Json::array(), secant = Json::array(),
       tangent = Json::array(), tangent_band = Json::array(), observations = Json::array();
  for (std::size_t j = 0; j < kProfileCells; ++j) {
    const double z = static_cast<double>(j + 1) * kProfileCell_m;
    const auto f = force_at(p, z);
    const ProfilePoint k{p.tangent_N_per_m[j], p.tangent_sd_N_per_m[j]};
    depth.push_back(z);
    force.push_back(f.value);
    band.push_back({f.low(), f.high()});
    secant.push_back(f.value / z);
    tangent.push_back(k.value);
    tangent_band.push_back({k.low(), k.high()});
    observations.push_back(p.observations[j]);
  }
  return {{"strides", p.stride},
          {"known_from_m", p.depth_min_m},
          {"known_to_m", p.depth_max_m},
          {"depth_m", depth},
          {"force_N", force},
          {"force_ci95_N", band},
          {"secant_N_per_m", secant},
          {"tangent_N_per_m", tangent},
          {"tangent_ci95_N_per_m", tangent_band},
          {"observations", observations},
          {"added_mass_factor", p.added_mass_factor},
          {"added_mass_factor_sd", p.added_mass_factor_sd},
          {"smoothness_m", p.smoothness_m},
          {"shape", name_of(g.shape)},
          {"line",
           {{"slope_N_per_m", g.line_N_per_m.value},
            {"ci95", {g.line_N_per_m.ci95_low, g.line_N_per_m.ci95_high}},
            {"valid", g.line_valid},
            {"chi_squared", g.line.statistic},
            {"limit", g.line.limit}}},
          {"secant_20mm_N_per_m",
           {{"value", g.secant_20mm_N_per_m.value},
            {"ci95", {g.secant_20mm_N_per_m.ci95_low, g.secant_20mm_N_per_m.ci95_high}}}},
          {"exponent", {{"value", g.exponent.value}, {"ci95", {g.exponent.ci95_low, g.exponent.ci95_high}}}},
          {"reloading_N_per_m",
           {{"value", g.reloading_N_per_m.value},
            {"ci95", {g.reloading_N_per_m.ci95_low, g.reloading_N_per_m.ci95_high}}}}};
}

std::vector<std::string> ground_event_lines(const GroundEvents& found) {
  std::vector<std::string> lines;
  for (const auto* e : found_in(found)) lines.push_back(fmt::format("{:<24} {}", "event", in_words(*e)));
  return lines;
}

nlohmann::ordered_json ground_events_json(const GroundEvents& found) {
  if (found.stride == 0) return nullptr;
  auto json = nlohmann::ordered_json::array();
  for (const auto* e : found_in(found))
    json.push_back({{"kind", name_of(e->kind)},
                    {"depth_m", e->depth_m},
                    {"force_N", e->force_N},
                    {"speed_mps", e->speed_mps},
                    {"size", e->size},
                    {"size_sd", e->size_sd},
                    {"size_unit", unit_of_size(e->kind)},
                    {"statistic", e->statistic},
                    {"threshold", e->threshold},
                    {"false_alarm_probability", GroundEventConfig{}.false_alarm_probability}});
  return json;
}

}  // namespace sandhopper
