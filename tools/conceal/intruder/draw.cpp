#include <algorithm>
#include <cmath>

#include "tools/conceal/intruder/world.hpp"

namespace sandhopper::conceal::intruder {

World draw(Random& random) {
  World w;
  w.bed.foot_radius_m = six_digits(random.uniform(0.025, 0.05));
  const double share = w.bed.area_m2() / 5.0265e-3;
  if (random.chance(0.3)) {
    w.bed.per_area_N_per_m3 = six_digits(random.uniform(2e5, 5e5));
    w.bed.exponent = six_digits(random.uniform(1.0, 1.3));
  } else {
    w.bed.stiffness_N_per_m = six_digits(random.uniform(1000.0, 2400.0) * share);
  }
  // Some beds have no added mass, and some beliefs contain none.
  if (random.chance(0.5)) w.bed.added_mass_factor = w.bed.drag_factor = 0.0;
  w.bed_stiffness_spread = six_digits(random.log_uniform(0.01, 0.03));
  w.bed_fluctuation = six_digits(random.log_uniform(0.005, 0.02));
  w.load_cell_noise_N = six_digits(random.log_uniform(0.05, 0.3));
  w.fastest_mps = six_digits(random.uniform(0.5, 1.1));
  return w;
}

Belief belief(const World& w) {
  Belief b;
  b.gravity_mps2 = w.gravity_mps2;
  b.tables.push_back({"foot", {{"radius_m", w.bed.foot_radius_m}}});
  b.tables.push_back({"terrain", terrain_keys(w.bed)});
  b.tables.push_back({"sensors",
                      {{"load_cell_rate_Hz", w.load_cell_rate_Hz},
                       {"load_cell_bandwidth_Hz", w.load_cell_bandwidth_Hz},
                       {"load_cell_noise_N", w.load_cell_noise_N},
                       {"position_noise_m", w.position_noise_m},
                       {"velocity_noise_mps", w.velocity_noise_mps},
                       {"accel_noise_mps2", w.accel_noise_mps2}}});
  b.tables.push_back({"spread",
                      {{"bed_stiffness_relative", w.bed_stiffness_spread},
                       {"bed_fluctuation_relative", w.bed_fluctuation},
                       {"surface_height_m", w.surface_height_spread_m},
                       {"load_cell_offset_N", w.load_cell_offset_spread_N}}});
  return b;
}

std::vector<Setup> draw_setups(const World& w, int trials, Random& random) {
  std::vector<Setup> setups;
  for (int i = 0; i < trials; ++i) {
    Setup s;
    s.keys["kind"] = "intrusion";
    const double share = (i % 4 + random.uniform()) / 4.0;
    const double speed = w.only_one_speed ? 0.3 : 0.02 * std::pow(w.fastest_mps / 0.02, share);
    const bool cyclic = !w.only_one_speed && i % 3 == 2;
    s.keys["impact_speed_mps"] = six_digits(speed);
    s.keys["depth_m"] = six_digits(w.only_one_speed ? w.deepest_m : w.deepest_m * random.uniform(0.7, 1.0));
    s.keys["profile"] = w.only_one_speed ? "through" : cyclic ? "cycles" : "stop_and_withdraw";
    s.keys["bed_depth_m"] = six_digits(random.uniform(0.06, 0.12));
    s.keys["wait_s"] = six_digits(random.log_uniform(1.0, 600.0));
    s.keys["pushes_since_preparation"] = w.only_one_speed ? 0 : i % 2 == 0 ? 0 : random.below(4);
    s.keys["session"] = 1 + i * 2 / trials;
    setups.push_back(std::move(s));
  }
  return setups;
}

}  // namespace sandhopper::conceal::intruder
