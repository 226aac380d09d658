#include "tools/conceal/rotary_axis/world.hpp"

// Friction that the belief does not contain. Typical sizes are a few per cent of the gravity torque of the
// arm (viscous: at 1 rad/s).
namespace sandhopper::conceal::rotary_axis {
namespace {

Json coulomb(World& w, double size, Random&) {
  w.hidden.coulomb_Nm = size * 0.05 * w.gravity_torque_Nm;
  return {{"coulomb_friction_change_Nm", w.hidden.coulomb_Nm}};
}

Json viscous(World& w, double size, Random&) {
  w.hidden.viscous_Nm_s = size * 0.02 * w.gravity_torque_Nm;
  return {{"viscous_friction_change_Nm_s", w.hidden.viscous_Nm_s}};
}

// Static friction above the sliding friction; it decays with speed as a Lorentzian.
Json stribeck(World& w, double size, Random& random) {
  w.hidden.stribeck_Nm = size * 0.05 * w.gravity_torque_Nm;
  w.hidden.stribeck_speed_radps = random.uniform(0.15, 0.5);
  return {{"extra_static_Nm", w.hidden.stribeck_Nm}, {"stribeck_speed_radps", w.hidden.stribeck_speed_radps}};
}

Json load_dependent(World& w, double size, Random&) {
  w.hidden.load_dependent = size * 0.03;
  return {{"friction_per_torque", w.hidden.load_dependent}};
}

}  // namespace

std::vector<Recipe<World>> friction_effects() {
  return {{{"axis.coulomb", "", "friction"}, coulomb},
          {{"axis.viscous", "", "viscous"}, viscous},
          {{"axis.stribeck", "", "friction"}, stribeck},
          {{"axis.load_dependent", "", "friction"}, load_dependent}};
}

}  // namespace sandhopper::conceal::rotary_axis
