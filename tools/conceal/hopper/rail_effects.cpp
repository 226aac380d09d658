#include "tools/conceal/hopper/world.hpp"

namespace sandhopper::conceal::hopper {
namespace {

Json rail_coulomb(World& w, double size, Random&) {
  w.hidden.rail_coulomb_N = size * 1.5;
  return {{"rail_coulomb_change_N", w.hidden.rail_coulomb_N}};
}

Json rail_viscous(World& w, double size, Random&) {
  w.hidden.rail_viscous_N_s_per_m = size * 1.2;
  return {{"viscous_N_s_per_m", w.hidden.rail_viscous_N_s_per_m}};
}

Json stribeck(World& w, double size, Random& random) {
  w.hidden.stribeck_N = size * 2.5;
  w.hidden.stribeck_mps = random.uniform(0.03, 0.1);
  return {{"extra_static_N", w.hidden.stribeck_N}, {"stribeck_speed_mps", w.hidden.stribeck_mps}};
}

Json load_dependent(World& w, double size, Random&) {
  w.hidden.rail_per_load = size * 0.04;
  return {{"friction_coefficient", w.hidden.rail_per_load}};
}

Json tilt(World& w, double size, Random& random) {
  w.hidden.rail_tilt_rad = random.sign() * size * 0.09;
  return {{"tilt_rad", w.hidden.rail_tilt_rad}};
}

Json cable(World& w, double size, Random& random) {
  w.hidden.cable_N_per_m = size * 8.0;
  w.hidden.cable_N = random.chance(0.5) ? size * 0.3 : 0.0;
  return {{"stiffness_N_per_m", w.hidden.cable_N_per_m}, {"hysteresis_N", w.hidden.cable_N}};
}

}  // namespace

std::vector<Recipe<World>> rail_effects() {
  return {{{"rail.coulomb", "", "rail"}, rail_coulomb},
          {{"rail.viscous", "", "rail"}, rail_viscous},
          {{"rail.stribeck", "", "rail"}, stribeck},
          {{"rail.load_dependent", "", "rail"}, load_dependent},
          {{"rail.tilt", "", "rail"}, tilt},
          {{"rail.cable", "", "rail"}, cable}};
}

}  // namespace sandhopper::conceal::hopper
