#include "tools/conceal/bed/bed_effects.hpp"

#include <cmath>

// Size 1 is the typical size (tools/conceal/README.md). Forces are scaled with the bed's own force at 20 mm.
namespace sandhopper::conceal {
namespace {

double at_20_mm_N(const Bed& bed) { return believed_static_N(bed, 0.02); }

Json added_mass(Bed& b, double size, Random&) {
  b.hidden.added_mass_kg = size * 0.12 * std::pow(b.foot_radius_m / 0.04, 3);
  b.hidden.added_mass_depth_m = 0.35 * b.foot_radius_m;
  return {{"added_mass_kg", b.hidden.added_mass_kg}, {"growth_depth_m", b.hidden.added_mass_depth_m}};
}

// Forces that depend on speed grow with the foot's area. Sizes refer to a radius of 40 mm; the answer states
// the force of the actual foot.
double share_of_area(const Bed& b) { return std::pow(b.foot_radius_m / 0.04, 2); }

Json quadratic(Bed& b, double size, Random&) {
  b.hidden.quadratic_N_s2_per_m2 = size * 6.0 * share_of_area(b);
  return {{"drag_N_s2_per_m2", b.hidden.quadratic_N_s2_per_m2}};
}

Json viscous(Bed& b, double size, Random&) {
  b.hidden.viscous_N_s_per_m = size * 5.0 * share_of_area(b);
  return {{"viscosity_N_s_per_m", b.hidden.viscous_N_s_per_m}};
}

Json coupling(Bed& b, double size, Random&) {
  b.hidden.coupling = size * 0.25;
  return {{"share_of_static_force", b.hidden.coupling}, {"speed_mps", b.hidden.coupling_speed_mps}};
}

Json power_law(Bed& b, double size, Random& random) {
  b.hidden.exponent_excess = random.chance(0.3) ? -0.15 * std::min(size, 2.5) : 0.2 * size;
  return {{"exponent_change", b.hidden.exponent_excess}};
}

Json floor(Bed& b, double size, Random&) {
  b.hidden.floor_stiffening = size * 2.0;
  return {{"share_at_floor", b.hidden.floor_stiffening}, {"length_m", 0.5 * b.foot_radius_m}};
}

Json tilt(Bed& b, double size, Random&) {
  const double tilt_rad = size * 0.035;
  b.hidden.tilt_depth_m = 2.0 * b.foot_radius_m * std::sin(std::min(tilt_rad, 0.3));
  return {{"tilt_rad", tilt_rad}};
}

Json crust(Bed& b, double size, Random&) {
  b.hidden.crust_N = size * 0.1 * at_20_mm_N(b);
  return {{"force_N", b.hidden.crust_N}, {"depth_m", b.hidden.crust_depth_m}};
}

Json unloading(Bed& b, double size, Random&) {
  b.hidden.unloading_softer = size * 2.0;
  return {{"unloading_stiffness_ratio", b.unloading_stiffness_ratio / (1.0 + b.hidden.unloading_softer)}};
}

Json suction(Bed& b, double size, Random&) {
  b.hidden.suction_N = size * 0.06 * at_20_mm_N(b);
  return {{"force_N", b.hidden.suction_N}};
}

Json compaction(Bed& b, double size, Random& random) {
  b.hidden.compaction = size * 0.25;
  b.hidden.compaction_pushes = random.uniform(1.0, 3.0);
  return {{"final_share", b.hidden.compaction}, {"pushes", b.hidden.compaction_pushes}};
}

Json crater(Bed& b, double size, Random&) {
  b.hidden.crater_m_per_push = size * 3e-3;
  return {{"drop_m_per_push", b.hidden.crater_m_per_push}};
}

Json strengthening(Bed& b, double size, Random&) {
  b.hidden.strengthening = size * 0.03;
  return {{"share_per_e_fold", b.hidden.strengthening}, {"time_constant_s", 1.0}};
}

Json weakening(Bed& b, double size, Random& random) {
  b.hidden.weakening = std::min(0.9, size * 0.3);
  b.hidden.weakening_at_mps = random.uniform(0.25, 0.5);
  return {{"share", b.hidden.weakening},
          {"at_mps", b.hidden.weakening_at_mps},
          {"width_mps", b.hidden.weakening_width_mps}};
}

Json ripple(Bed& b, double size, Random& random) {
  b.hidden.ripple_N = size * 0.1 * at_20_mm_N(b);
  b.hidden.ripple_length_m = random.uniform(4e-3, 9e-3);
  return {{"amplitude_N", b.hidden.ripple_N}, {"length_m", b.hidden.ripple_length_m}};
}

Json layer(Bed& b, double size, Random& random) {
  b.hidden.layer_N = size * 0.25 * at_20_mm_N(b);
  b.hidden.layer_at_m = random.uniform(0.008, 0.02);
  b.hidden.layer_width_m = random.uniform(2e-3, 5e-3);
  return {{"peak_N", b.hidden.layer_N}, {"at_m", b.hidden.layer_at_m}, {"width_m", b.hidden.layer_width_m}};
}

Json shaken(Bed& b, double size, Random& random) {
  b.hidden.shaken = std::min(0.9, size * 0.35);
  b.hidden.shaken_s = random.uniform(0.015, 0.04);
  return {{"share", b.hidden.shaken}, {"time_constant_s", b.hidden.shaken_s}};
}

}  // namespace

Recipe<Bed> bed_added_mass() { return {{"terrain.added_mass", "", "inertial"}, added_mass}; }

std::vector<Recipe<Bed>> bed_speed_effects() {
  return {bed_added_mass(),
          {{"terrain.quadratic_drag", "", "inertial"}, quadratic},
          {{"terrain.viscous", "", "inertial"}, viscous},
          {{"terrain.depth_speed_coupling", "", "inertial"}, coupling}};
}

std::vector<Recipe<Bed>> bed_depth_effects() {
  return {{{"terrain.depth_power_law", "", "depth"}, power_law},
          {{"terrain.floor_stiffening", "", "depth"}, floor},
          {{"terrain.foot_tilt", "", "depth"}, tilt},
          {{"terrain.crust", "", "depth"}, crust},
          {{"terrain.unloading", "", "unloading"}, unloading},
          {{"terrain.suction", "", "unloading"}, suction}};
}

std::vector<Recipe<Bed>> bed_history_effects() {
  return {{{"terrain.compaction", "", "history"}, compaction},
          {{"terrain.crater", "", "history"}, crater},
          {{"terrain.strengthening", "", "history"}, strengthening}};
}

std::vector<Recipe<Bed>> bed_unlisted_effects() {
  return {{{"weakening_at_a_speed", "ground", "u"}, weakening},
          {{"stick_slip_of_grains", "ground", "u"}, ripple},
          {{"buried_layer", "ground", "u"}, layer},
          {{"shaken_soft", "ground", "u"}, shaken}};
}

}  // namespace sandhopper::conceal
