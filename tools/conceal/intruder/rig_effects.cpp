#include "tools/conceal/core/fault_recipes.hpp"
#include "tools/conceal/intruder/world.hpp"

namespace sandhopper::conceal::intruder {
namespace {

Json compliance(World& w, double size, Random&) {
  w.rig_stiffness_N_per_m = 2.5e4 / size;
  return {{"stiffness_N_per_m", w.rig_stiffness_N_per_m}};
}

Json lag(World& w, double size, Random&) {
  w.faults["force_N"].lag_s = size * 4e-3;
  return {{"time_constant_s", size * 4e-3}};
}

Json gain(World& w, double size, Random& random) {
  const double error = random.sign() * size * 0.05;
  w.faults["force_N"].gain *= 1.0 + error;
  return {{"scale_error", error}};
}

Json offset(World& w, double size, Random& random) {
  const double offset_N = random.sign() * size * 0.6;
  w.faults["force_N"].offset += offset_N;
  return {{"offset_N", offset_N}};
}

Json inertia(World& w, double size, Random&) {
  w.plate_mass_kg = size * 0.1;
  return {{"mass_kg", w.plate_mass_kg}};
}

Json bias(World& w, double size, Random& random) {
  const double bias_m = random.sign() * size * 2e-3;
  w.faults["foot_z_m"].offset += bias_m;
  return {{"channel", "foot_z_m"}, {"bias", bias_m}};
}

Json saturation(World& w, double size, Random&) {
  const double limit_N = 1.05 * believed_static_N(w.bed, w.deepest_m) / (1.0 + 0.5 * size);
  w.faults["force_N"].limit = limit_N;
  return {{"channel", "force_N"}, {"limit", limit_N}};
}

}  // namespace

std::vector<Recipe<World>> rig_effects() {
  auto all = data_fault_recipes<World>(
      [](const World&) {
        return std::vector<std::string>{"force_N", "foot_z_m"};
      },
      4e-3);
  append(all, {{{"rig.compliance", "", "depth"}, compliance},
               {{"load_cell.lag", "", "clock"}, lag},
               {{"load_cell.gain", "", "gain"}, gain},
               {{"load_cell.offset", "", "offset"}, offset},
               {{"load_cell.inertia", "", "inertial"}, inertia},
               {{"sensor.bias", "", "depth"}, bias},
               {{"sensor.saturation", "", "data"}, saturation}});
  return all;
}

// All trials have the same speed, so functions of speed cannot be distinguished.
std::vector<Restriction<World>> restrictions() {
  const auto one_speed = [](World& w) { w.only_one_speed = true; };
  return {{{{"terrain.viscous", "terrain.quadratic_drag"}}, one_speed},
          {{{"terrain.quadratic_drag", "terrain.viscous"}}, one_speed}};
}

}  // namespace sandhopper::conceal::intruder
