#include <algorithm>

#include "tools/conceal/hopper/world.hpp"

namespace sandhopper::conceal::hopper {
namespace {

Json body(World& w, double size, Random& random) {
  w.hidden.body_kg = std::max(-0.5, random.sign() * size * 0.05) * w.robot.body_kg;
  return {{"body_mass_change_kg", w.hidden.body_kg}};
}

Json foot(World& w, double size, Random& random) {
  w.hidden.foot_kg = std::max(-0.3, random.sign() * size * 0.06);
  return {{"foot_mass_change_kg", w.hidden.foot_kg}};
}

Json link(World& w, double size, Random&) {
  const double extra_kg = size * 0.02;
  w.hidden.lower_kg = extra_kg;
  return {{"lower_link_mass_change_kg", extra_kg}};
}

}  // namespace

std::vector<Recipe<World>> mass_effects() {
  return {{{"body.mass", "", "inertia"}, body},
          {{"foot.mass", "", "inertia"}, foot},
          {{"leg.link_mass", "", "inertia"}, link}};
}

}  // namespace sandhopper::conceal::hopper
