#include "tools/plant/bed_truth.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "config/json.hpp"

namespace sandhopper {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

std::optional<double> number_of(const Json& json) {
  return json.is_null() ? std::nullopt : std::optional<double>(json.get<double>());
}

}  // namespace

double BedTruth::force_at_N(double depth) const noexcept {
  const auto above = std::ranges::upper_bound(depth_m, depth);
  if (above == depth_m.begin()) return std::numeric_limits<double>::quiet_NaN();
  const auto i = static_cast<std::size_t>(above - depth_m.begin()) - 1;
  if (i + 1 == depth_m.size())
    return depth == depth_m[i] ? force_N[i] : std::numeric_limits<double>::quiet_NaN();
  const double share = (depth - depth_m[i]) / (depth_m[i + 1] - depth_m[i]);
  return force_N[i] + share * (force_N[i + 1] - force_N[i]);
}

BedTruth bed_truth_of(const Bed& bed) {
  constexpr int kPoints = 241;
  constexpr double kSpacing_m = 5e-4;
  const auto& family = bed.family();
  BedTruth truth{.family = std::string(name_of(family.family)),
                 .foot_radius_m = bed.foot_radius_m(),
                 .unloading_stiffness_N_per_m = bed.unloading_line_N_per_m()};
  if (family.crust_shear_strength_Pa > 0.0) truth.rupture_depth_m = family.rupture_depth_m();
  if (family.deep_strength_ratio != 1.0 && family.densification_depth_m == 0.0)
    truth.boundary_depth_m = family.boundary_depth_m;
  if (family.floor_depth_m > 0.0) truth.floor_depth_m = family.floor_depth_m;
  const bool line = family.family != BedFamily::power_law && family.deep_strength_ratio == 1.0 &&
                    !truth.rupture_depth_m && !truth.floor_depth_m &&
                    bed.parameters().stiffness_per_area_N_per_m3 == 0.0;
  if (line) truth.line_N_per_m = bed.parameters().stiffness_N_per_m * family.strength_factor;
  if (family.suction_Pa > 0.0) truth.suction_N = bed.greatest_suction_N();
  for (int i = 0; i < kPoints; ++i) {
    truth.depth_m.push_back(i * kSpacing_m);
    truth.force_N.push_back(bed.quasi_static_force_N(i * kSpacing_m));
  }
  return truth;
}

std::string bed_truth_text(const Bed& bed) {
  const BedTruth truth = bed_truth_of(bed);
  const Json json{{"family", truth.family},
                  {"foot_radius_m", truth.foot_radius_m},
                  {"unloading_stiffness_N_per_m", truth.unloading_stiffness_N_per_m},
                  {"rupture_depth_m", json_of(truth.rupture_depth_m)},
                  {"boundary_depth_m", json_of(truth.boundary_depth_m)},
                  {"floor_depth_m", json_of(truth.floor_depth_m)},
                  {"suction_N", json_of(truth.suction_N)},
                  {"depth_m", truth.depth_m},
                  {"force_N", truth.force_N},
                  {"bed", to_json(bed.parameters())},
                  {"bed_family", to_json(bed.family())}};
  return json.dump();
}

BedTruth read_bed_truth(std::string_view text) {
  BedTruth truth;
  try {
    const auto json = Json::parse(text);
    truth.family = json.at("family").get<std::string>();
    truth.foot_radius_m = json.at("foot_radius_m").get<double>();
    truth.unloading_stiffness_N_per_m = json.at("unloading_stiffness_N_per_m").get<double>();
    truth.rupture_depth_m = number_of(json.at("rupture_depth_m"));
    truth.boundary_depth_m = number_of(json.at("boundary_depth_m"));
    truth.floor_depth_m = number_of(json.at("floor_depth_m"));
    truth.suction_N = number_of(json.at("suction_N"));
    truth.depth_m = json.at("depth_m").get<std::vector<double>>();
    truth.force_N = json.at("force_N").get<std::vector<double>>();
  } catch (const Json::exception& error) {
    throw std::runtime_error(std::string(kBedTruthAttachment) +
                             ": not a simulated bed's curve: " + error.what());
  }
  if (truth.depth_m.size() != truth.force_N.size() || truth.depth_m.size() < 2 ||
      !std::ranges::is_sorted(truth.depth_m))
    throw std::runtime_error(std::string(kBedTruthAttachment) +
                             ": expected as many forces as ascending depths, two at least");
  return truth;
}

}  // namespace sandhopper
