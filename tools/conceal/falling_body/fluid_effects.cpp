#include <algorithm>
#include <cmath>

#include "tools/conceal/falling_body/world.hpp"

// Forces of the fluid, and the mass of the body. Typical sizes depend on the largest speed of this rig.
namespace sandhopper::conceal::falling_body {

double heaviness_kg(const World& w) {
  return std::max(0.1 * w.mass_kg, w.mass_kg - w.buoyancy_factor * w.density_kg_per_m3 * w.volume_m3);
}

double top_speed_mps(const World& w) {
  const double believed = 0.5 * w.density_kg_per_m3 * w.frontal_area_m2 * w.drag_coefficient;
  const double free = std::sqrt(2.0 * w.gravity_mps2 * heaviness_kg(w) / w.mass_kg * w.most_release_m);
  return believed > 0.0 ? std::min(free, std::sqrt(heaviness_kg(w) * w.gravity_mps2 / believed)) : free;
}

namespace {

// Size 1: a tenth of the weight at the largest speed. The answer also states it as a drag coefficient.
Json quadratic(World& w, double size, Random&) {
  const double v = top_speed_mps(w);
  w.hidden.quadratic = size * 0.1 * heaviness_kg(w) * w.gravity_mps2 / (v * v);
  return {{"drag_N_s2_per_m2", w.hidden.quadratic},
          {"drag_coefficient_change", w.hidden.quadratic / (0.5 * w.density_kg_per_m3 * w.frontal_area_m2)}};
}

Json linear(World& w, double size, Random&) {
  w.hidden.linear_N_s_per_m = size * 0.08 * heaviness_kg(w) * w.gravity_mps2 / top_speed_mps(w);
  return {{"linear_drag_N_s_per_m", w.hidden.linear_N_s_per_m}};
}

Json buoyancy(World& w, double size, Random&) {
  const double displaced_kg = w.density_kg_per_m3 * w.volume_m3;
  w.hidden.buoyancy = size * 0.04 * w.mass_kg / displaced_kg;
  return {{"buoyancy_factor_change", w.hidden.buoyancy}};
}

Json added_mass(World& w, double size, Random&) {
  const double displaced_kg = w.density_kg_per_m3 * w.volume_m3;
  w.hidden.added_mass = size * 0.08 * w.mass_kg / displaced_kg;
  return {{"added_mass_factor_change", w.hidden.added_mass},
          {"added_mass_kg", w.hidden.added_mass * displaced_kg}};
}

Json mass(World& w, double size, Random& random) {
  w.hidden.mass_share = std::max(-0.4, random.sign() * size * 0.08);
  return {{"mass_change_kg", w.hidden.mass_share * w.mass_kg}};
}

}  // namespace

std::vector<Recipe<World>> fluid_effects() {
  return {{{"air.quadratic_drag", "", "drag"}, quadratic},
          {{"air.linear_drag", "", "drag"}, linear},
          {{"fluid.buoyancy", "", "inertia"}, buoyancy},
          {{"fluid.added_mass", "", "inertia"}, added_mass},
          {{"body.mass", "", "inertia"}, mass}};
}

}  // namespace sandhopper::conceal::falling_body
