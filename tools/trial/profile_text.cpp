#include "tools/trial/profile_text.hpp"

#include <fmt/format.h>

#include <array>

namespace sandhopper {
namespace {

std::string interval(const ProfilePoint& p, int digits) {
  return fmt::format("{:.{}f}  [{:.{}f}, {:.{}f}]", p.value, digits, p.low(), digits, p.high(), digits);
}

}  // namespace

std::vector<std::string> profile_lines(const StrengthProfile& p) {
  if (p.stride == 0) return {};
  if (p.depth_max_m <= 0.0) return {"ground: no new depth was reached"};
  std::vector<std::string> lines{fmt::format("ground known from {:.1f} to {:.1f} mm{}", 1e3 * p.depth_min_m,
                                             1e3 * p.depth_max_m,
                                             p.stride > 1 ? ", all strides together" : "")};
  for (const double depth_m : {0.010, 0.020, 0.030, 0.040, 0.050}) {
    const bool known = depth_m >= p.depth_min_m && depth_m <= p.depth_max_m;
    if (!known) continue;
    const auto force = force_at(p, depth_m);
    const ProfilePoint secant{force.value / depth_m, force.sd / depth_m};
    lines.push_back(fmt::format("  at {:2.0f} mm  {:>22} N   secant {:>22} N/m   tangent {:>22} N/m", 1e3 * depth_m,
                                interval(force, 1), interval(secant, 0), interval(tangent_at(p, depth_m), 0)));
  }
  return lines;
}

nlohmann::ordered_json profile_json(const StrengthProfile& p) {
  if (p.stride == 0) return nullptr;
  using Json = nlohmann::ordered_json;
  Json depth = Json::array(), force = Json::array(), band = Json::array(), secant = Json::array(),
       tangent = Json::array(), tangent_band = Json::array(), observations = Json::array();
  for (std::size_t j = 0; j < kProfileCells; ++j) {
    const double z = static_cast<double>(j + 1) * kProfileCell_m;
    const ProfilePoint f{p.force_N[j], p.force_sd_N[j]}, k{p.tangent_N_per_m[j], p.tangent_sd_N_per_m[j]};
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
          {"smoothness_m", p.smoothness_m}};
}

}  // namespace sandhopper
