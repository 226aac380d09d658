#include <algorithm>
#include <numbers>

#include "tools/conceal/rotary_axis/world.hpp"

namespace sandhopper::conceal::rotary_axis {

World draw(Random& random) {
  World w;
  const double mass_kg = random.uniform(0.4, 1.5), length_m = random.uniform(0.25, 0.6);
  w.inertia_kg_m2 = six_digits(mass_kg * length_m * length_m * random.uniform(1.0, 1.2));
  w.gravity_torque_Nm = six_digits(mass_kg * w.gravity_mps2 * length_m);
  // Beliefs contain different parts of the friction.
  if (random.chance(0.5)) w.viscous_Nm_s = six_digits(random.log_uniform(0.003, 0.03));
  if (random.chance(0.5)) w.coulomb_Nm = six_digits(random.log_uniform(0.03, 0.15));
  w.gear_ratio = random.chance(0.5) ? 6.0 : 9.0;
  constexpr double kRates_Hz[] = {200.0, 500.0, 500.0, 1000.0};
  w.row_rate_Hz = kRates_Hz[random.below(4)];
  w.duration_s = random.chance(0.5) ? 4.0 : 6.0;
  w.position_range_rad = random.chance(0.5) ? 12.5 : 95.5;
  w.torque_noise_Nm = six_digits(random.log_uniform(0.01, 0.04));
  w.velocity_noise_radps = six_digits(random.log_uniform(0.01, 0.05));
  w.bench_load_cell = random.chance(0.3);
  return w;
}

Belief belief(const World& w) {
  Belief b;
  b.gravity_mps2 = w.gravity_mps2;
  b.tables.push_back({"axis",
                      {{"inertia_kg_m2", w.inertia_kg_m2},
                       {"gravity_torque_Nm", w.gravity_torque_Nm},
                       {"viscous_friction_Nm_s", w.viscous_Nm_s},
                       {"coulomb_friction_Nm", w.coulomb_Nm},
                       {"friction_switch_speed_radps", w.friction_switch_speed_radps},
                       {"gear_ratio", w.gear_ratio}}});
  b.tables.push_back({"sensors",
                      {{"position_range_rad", w.position_range_rad},
                       {"position_bits", w.position_bits},
                       {"position_noise_rad", w.position_noise_rad},
                       {"velocity_range_radps", w.velocity_range_radps},
                       {"velocity_bits", w.velocity_bits},
                       {"velocity_noise_radps", w.velocity_noise_radps},
                       {"encoder_velocity_bandwidth_Hz", w.velocity_bandwidth_Hz},
                       {"torque_range_Nm", w.torque_range_Nm},
                       {"torque_bits", w.torque_bits},
                       {"torque_noise_Nm", w.torque_noise_Nm}}});
  b.tables.push_back({"spread",
                      {{"initial_position_rad", w.initial_position_spread_rad},
                       {"torque_offset_Nm", w.torque_offset_spread_Nm}}});
  return b;
}

std::vector<Setup> draw_setups(const World& w, int trials, Random& random) {
  std::vector<Setup> setups;
  for (int i = 0; i < trials; ++i) {
    Setup s;
    s.keys["kind"] = w.only_held ? "hold" : "motion";
    const auto number = [&](const char* key, double value) { s.keys[key] = six_digits(value); };
    // Any five consecutive trials contain every profile: slow, fast, free, and far from the bottom.
    const int profile = w.only_free_swing ? 2 : i % 5;
    if (w.only_held) {
      number("position_rad", random.sign() * random.uniform(0.3, 2.5));
    } else if (profile == 0 || profile == 1) {
      s.keys["profile"] = profile == 0 ? "sine" : "chirp";
      number("amplitude_rad", random.uniform(0.4, 1.6));
      number("frequency_Hz", random.log_uniform(0.3, 1.5));
      if (profile == 1) number("end_frequency_Hz", random.uniform(1.5, 2.5));
    } else if (profile == 2) {
      s.keys["profile"] = "release";
      number("release_position_rad", random.sign() * random.uniform(0.6, 2.4));
    } else if (profile == 3) {
      s.keys["profile"] = "ramp";  // back and forth at constant speed
      number("speed_radps", random.log_uniform(0.1, 3.0));
      number("amplitude_rad", random.uniform(0.8, 1.5));
    } else {
      s.keys["profile"] = "steps";
      number("amplitude_rad", random.uniform(0.5, 2.0));
      number("hold_s", 1.0);
    }
    number("duration_s", w.duration_s);
    s.keys["session"] = 1 + i * 2 / std::max(trials, 1);
    setups.push_back(std::move(s));
  }
  return setups;
}

}  // namespace sandhopper::conceal::rotary_axis
