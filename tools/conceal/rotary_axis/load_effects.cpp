#include "tools/conceal/rotary_axis/world.hpp"

// Effects by which the load differs from the believed one.
namespace sandhopper::conceal::rotary_axis {
namespace {

Json inertia(World& w, double size, Random& random) {
  w.hidden.inertia_share = std::max(-0.5, random.sign() * size * 0.10);
  return {{"inertia_change_kg_m2", w.hidden.inertia_share * w.inertia_kg_m2}};
}

Json gravity(World& w, double size, Random& random) {
  w.hidden.gravity_share = std::max(-0.5, random.sign() * size * 0.05);
  return {{"gravity_torque_change_Nm", w.hidden.gravity_share * w.gravity_torque_Nm}};
}

Json offset(World& w, double size, Random& random) {
  w.hidden.offset_rad = random.sign() * size * 0.03;
  return {{"offset_rad", w.hidden.offset_rad}};
}

}  // namespace

std::vector<Recipe<World>> load_effects() {
  return {{{"axis.inertia", "", "load"}, inertia},
          {{"axis.gravity", "", "load"}, gravity},
          {{"axis.offset", "", "offset"}, offset}};
}

}  // namespace sandhopper::conceal::rotary_axis
