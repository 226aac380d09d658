#include <cmath>
#include <numbers>

#include "tools/conceal/falling_body/world.hpp"

namespace sandhopper::conceal::falling_body {
namespace {

void ball_in_air(World& w, Random& random) {
  const double radius_m = random.uniform(0.02, 0.11);
  w.frontal_area_m2 = six_digits(std::numbers::pi * radius_m * radius_m);
  w.volume_m3 = six_digits(4.0 / 3.0 * std::numbers::pi * std::pow(radius_m, 3));
  w.mass_kg = six_digits(w.volume_m3 * random.log_uniform(60.0, 1500.0));
  w.density_kg_per_m3 = 1.2;
  w.least_release_m = 2.0;
  w.most_release_m = random.log_uniform(6.0, 35.0);
  w.height_rate_Hz = random.chance(0.5) ? 60.0 : 240.0;
  w.height_noise_m = six_digits(random.log_uniform(1e-3, 1e-2));
  w.has_accel = random.chance(0.6);
  // Some beliefs contain the drag, others contain none.
  if (random.chance(0.5)) w.drag_coefficient = six_digits(random.uniform(0.35, 0.6));
}

void probe_in_water(World& w, Random& random) {
  const double radius_m = random.uniform(0.025, 0.06);
  w.frontal_area_m2 = six_digits(std::numbers::pi * radius_m * radius_m);
  w.volume_m3 = six_digits(w.frontal_area_m2 * random.uniform(0.25, 0.6));
  w.mass_kg = six_digits(w.volume_m3 * random.uniform(2000.0, 4500.0));
  w.density_kg_per_m3 = 1000.0;
  w.least_release_m = 1.0;
  w.most_release_m = random.uniform(2.0, 5.0);
  w.has_height = random.chance(0.7);
  w.height_noise_m = six_digits(random.log_uniform(1e-3, 6e-3));
  w.buoyancy_factor = 1.0;
  w.drag_coefficient = six_digits(random.uniform(0.3, 0.9));
  w.added_mass_factor = six_digits(random.uniform(0.1, 0.5));
  w.row_rate_Hz = 1000.0;
  w.has_bed = random.chance(0.6);
  w.bed_stiffness_N_per_m = six_digits(w.mass_kg * random.log_uniform(500.0, 5000.0));
}

}  // namespace

World draw(Random& random) {
  World w;
  random.chance(0.5) ? ball_in_air(w, random) : probe_in_water(w, random);
  w.accel_noise_mps2 = six_digits(random.log_uniform(0.02, 0.15));
  w.release_speed_spread_mps = six_digits(random.log_uniform(0.005, 0.03));
  w.accel_bias_spread_mps2 = six_digits(random.log_uniform(0.005, 0.03));
  return w;
}

Belief belief(const World& w) {
  Belief b;
  b.gravity_mps2 = w.gravity_mps2;
  if (w.has_bed)
    b.tables.push_back(
        {"bed", {{"surface_height_m", w.surface_height_m}, {"stiffness_N_per_m", w.bed_stiffness_N_per_m}}});
  b.tables.push_back(
      {"body", {{"mass_kg", w.mass_kg}, {"frontal_area_m2", w.frontal_area_m2}, {"volume_m3", w.volume_m3}}});
  b.tables.push_back({"medium",
                      {{"density_kg_per_m3", w.density_kg_per_m3},
                       {"drag_coefficient", w.drag_coefficient},
                       {"linear_drag_N_s_per_m", w.linear_drag_N_s_per_m},
                       {"buoyancy_factor", w.buoyancy_factor},
                       {"added_mass_factor", w.added_mass_factor}}});
  b.tables.push_back(
      {"sensors", {{"height_noise_m", w.height_noise_m}, {"accel_noise_mps2", w.accel_noise_mps2}}});
  b.tables.push_back({"spread",
                      {{"release_height_m", w.release_height_spread_m},
                       {"release_speed_mps", w.release_speed_spread_mps},
                       {"accel_bias_mps2", w.accel_bias_spread_mps2},
                       {"bed_stiffness_relative", w.bed_stiffness_spread}}});
  return b;
}

std::vector<Setup> draw_setups(const World& w, int trials, Random& random) {
  std::vector<Setup> setups;
  for (int i = 0; i < trials; ++i) {
    Setup s;
    s.keys["kind"] = "drop";
    // Any four consecutive trials cover the whole range.
    const double share = (i % 4 + random.uniform(0.2, 0.8)) / 4.0;
    s.keys["release_height_m"] =
        six_digits(w.least_release_m * std::pow(w.most_release_m / w.least_release_m, share));
    s.keys["release_speed_mps"] = 0.0;
    s.keys["session"] = 1 + i * 2 / trials;
    setups.push_back(std::move(s));
  }
  return setups;
}

}  // namespace sandhopper::conceal::falling_body
