#include "tools/conceal/hopper/world.hpp"

// Effects at hip and knee. The sizes in the answer are those of one side.
namespace sandhopper::conceal::hopper {
namespace {

Json joint_coulomb(World& w, double size, Random&) {
  w.hidden.joint_coulomb_Nm = size * 0.04;
  return {{"joint_coulomb_change_Nm", w.hidden.joint_coulomb_Nm}};
}

Json joint_viscous(World& w, double size, Random&) {
  w.hidden.joint_viscous_Nm_s = size * 6e-3;
  return {{"joint_viscous_Nm_s_per_rad", w.hidden.joint_viscous_Nm_s}};
}

Json cogging(World& w, double size, Random& random) {
  w.hidden.cogging_Nm = size * 0.05;
  w.hidden.cogging_per_rev = random.chance(0.5) ? 36.0 : 84.0;
  w.hidden.cogging_phase_rad = random.uniform(0.0, 6.28);
  return {{"amplitude_Nm", w.hidden.cogging_Nm}, {"periods_per_rev", w.hidden.cogging_per_rev}};
}

Json rotor(World& w, double size, Random&) {
  w.hidden.rotor_kg_m2 = size * 1e-4;
  return {{"rotor_inertia_change_kg_m2", w.hidden.rotor_kg_m2}};
}

Json backlash(World& w, double size, Random&) {
  w.hidden.backlash_rad = size * 0.008;
  return {{"play_rad", w.hidden.backlash_rad}};
}

Json elasticity(World& w, double size, Random&) {
  w.hidden.series_N_per_m = 4e4 / size;
  return {{"stiffness_N_per_m", w.hidden.series_N_per_m}};
}

Json geometry(World& w, double size, Random& random) {
  const bool upper = random.chance(0.5);
  const double error_m = random.sign() * size * 2e-3;
  (upper ? w.hidden.upper_m : w.hidden.lower_m) = error_m;
  return {{upper ? "upper_link_length_change_m" : "lower_link_length_change_m", error_m}};
}

}  // namespace

std::vector<Recipe<World>> joint_effects() {
  return {
      {{"joint.coulomb", "", "joint"}, joint_coulomb}, {{"joint.viscous", "", "joint"}, joint_viscous},
      {{"joint.cogging", "", "cogging"}, cogging},     {{"joint.rotor_inertia", "", "inertia"}, rotor},
      {{"joint.backlash", "", "play"}, backlash},      {{"leg.series_elasticity", "", "play"}, elasticity},
      {{"leg.geometry", "", "geometry"}, geometry}};
}

}  // namespace sandhopper::conceal::hopper
