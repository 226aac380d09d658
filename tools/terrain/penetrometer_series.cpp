#include <fmt/format.h>

#include "tools/terrain/penetrometer.hpp"

// Converts a drop to a list of numbers that is stored in its trial's result.
namespace sandhopper {

void keep_numbers(const PenetrometerDrop& drop, TrialResult& result) {
  auto& series = result.series;
  series["drop"] = {drop.rest_bias_mps2,
                    drop.cos_tilt,
                    drop.impact_speed_mps,
                    drop.speed_before_release_mps,
                    drop.depth_m,
                    drop.fluid.alpha,
                    drop.fluid.kappa_per_m,
                    drop.fluid.rms_mps2,
                    drop.fluid.condition,
                    drop.mass_min_kg,
                    drop.mass_max_kg,
                    drop.body.mass_kg,
                    drop.body.volume_m3,
                    drop.body.frontal_area_m2,
                    drop.body.density_kg_per_m3,
                    static_cast<double>(drop.fused.reference),
                    drop.fallen_m,
                    drop.fallen_by_pressure_m};
  for (const auto& c : drop.fused.calibration)
    for (const double number :
         {c.scale, c.bias_mps2, c.noise_mps2, c.saturation_mps2, static_cast<double>(c.saturated_samples)})
      series["drop_accelerometers"].push_back(number);
  for (const auto& sample : drop.penetration) {
    series["drop_depth_m"].push_back(sample.depth_m);
    series["drop_speed_mps"].push_back(sample.speed_mps);
    series["drop_resistance_mps2"].push_back(sample.resistance);
  }
  series["drop_impact_t_s"] = drop.t_s;
  series["drop_impact_specific_force_mps2"] = drop.specific_force_mps2;
  series["drop_impact_source"] = drop.source;
}

bool holds_drop(const TrialResult& result) { return result.series.contains("drop_resistance_mps2"); }

PenetrometerDrop drop_from(const TrialResult& result) {
  const auto& series = result.series;
  const auto& n = series.at("drop");
  PenetrometerDrop drop;
  drop.trial = result.trial;
  drop.rest_bias_mps2 = n.at(0);
  drop.cos_tilt = n.at(1);
  drop.impact_speed_mps = n.at(2);
  drop.speed_before_release_mps = n.at(3);
  drop.depth_m = n.at(4);
  drop.fluid.alpha = n.at(5);
  drop.fluid.kappa_per_m = n.at(6);
  drop.fluid.rms_mps2 = n.at(7);
  drop.fluid.condition = n.at(8);
  drop.mass_min_kg = n.at(9);
  drop.mass_max_kg = n.at(10);
  drop.body = {n.at(11), n.at(12), n.at(13), n.at(14)};
  drop.fused.reference = static_cast<std::size_t>(n.at(15));
  drop.fallen_m = n.at(16);
  drop.fallen_by_pressure_m = n.at(17);
  const auto& c = series.at("drop_accelerometers");
  for (std::size_t i = 0; i + 4 < c.size(); i += 5) {
    drop.fused.calibration.push_back(
        {c[i], c[i + 1], c[i + 2], c[i + 3], static_cast<std::size_t>(c[i + 4])});
    const auto place = drop.names.size() + 1;
    drop.names.push_back(place == 1 ? "accel_mps2" : fmt::format("accel_{}_mps2", place));
  }
  const auto &z = series.at("drop_depth_m"), &v = series.at("drop_speed_mps"),
             &r = series.at("drop_resistance_mps2");
  for (std::size_t i = 0; i < z.size(); ++i) drop.penetration.push_back({z[i], v[i], r[i]});
  drop.t_s = series.at("drop_impact_t_s");
  drop.specific_force_mps2 = series.at("drop_impact_specific_force_mps2");
  drop.source = series.at("drop_impact_source");
  return drop;
}

}  // namespace sandhopper
