#include "tools/conceal/rotary_axis/world.hpp"

// Unlisted effects, all of them at the axis.
namespace sandhopper::conceal::rotary_axis {
namespace {

Json magnet(World& w, double size, Random& random) {
  w.hidden.magnet_Nm = size * 0.15 * w.gravity_torque_Nm;
  w.hidden.magnet_at_rad = random.uniform(-0.4, 0.6);
  w.hidden.magnet_width_rad = random.uniform(0.06, 0.15);
  return {{"peak_Nm", w.hidden.magnet_Nm},
          {"at_rad", w.hidden.magnet_at_rad},
          {"width_rad", w.hidden.magnet_width_rad}};
}

Json rub(World& w, double size, Random& random) {
  w.hidden.rub_Nm = size * 0.15 * w.gravity_torque_Nm;
  w.hidden.rub_from_rad = random.uniform(-0.3, 0.3);
  w.hidden.rub_to_rad = w.hidden.rub_from_rad + random.uniform(0.2, 0.4);
  return {
      {"friction_Nm", w.hidden.rub_Nm}, {"from_rad", w.hidden.rub_from_rad}, {"to_rad", w.hidden.rub_to_rad}};
}

// An eddy-current brake has its largest torque at one speed.
Json eddy_brake(World& w, double size, Random& random) {
  w.hidden.brake_Nm = size * 0.05 * w.gravity_torque_Nm;
  w.hidden.brake_speed_radps = random.uniform(0.5, 1.5);
  return {{"peak_Nm", w.hidden.brake_Nm}, {"at_radps", w.hidden.brake_speed_radps}};
}

Json hysteresis(World& w, double size, Random& random) {
  w.hidden.spring_yield_rad = random.uniform(0.08, 0.25);
  w.hidden.spring_Nm_per_rad = size * 0.10 * w.gravity_torque_Nm / w.hidden.spring_yield_rad;
  return {{"stiffness_Nm_per_rad", w.hidden.spring_Nm_per_rad}, {"yield_rad", w.hidden.spring_yield_rad}};
}

}  // namespace

std::vector<Recipe<World>> unlisted_effects() {
  return {{{"magnet_at_an_angle", "axis", "u"}, magnet},
          {{"rub_in_a_sector", "axis", "u"}, rub},
          {{"eddy_brake", "axis", "u"}, eddy_brake},
          {{"hysteretic_spring", "axis", "u"}, hysteresis}};
}

// A free swing without believed friction determines only gravity / inertia. An arm that is held determines
// only gravity / torque.
std::vector<Restriction<World>> restrictions() {
  const auto free_swing = [](World& w) {
    w.only_free_swing = true;
    w.viscous_Nm_s = w.coulomb_Nm = 0.0;
    w.bench_load_cell = false;
  };
  const auto held = [](World& w) { w.only_held = true, w.bench_load_cell = false; };
  return {{{{"axis.inertia", "axis.gravity"}}, free_swing},
          {{{"axis.gravity", "axis.inertia"}}, free_swing},
          {{{"axis.gravity", "axis.torque_scale"}}, held},
          {{{"axis.torque_scale", "axis.gravity"}}, held}};
}

}  // namespace sandhopper::conceal::rotary_axis
