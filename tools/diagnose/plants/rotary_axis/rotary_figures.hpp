#pragma once
#include <algorithm>

#include "tools/diagnose/model/context.hpp"
#include "tools/diagnose/model/edits.hpp"

namespace sandhopper::diagnose {

// Parameters of the axis: numbers of the belief after the edits.
struct RotaryFigures {
  double inertia_kg_m2, gravity_torque_Nm, viscous_Nm_s, coulomb_Nm, switch_speed_radps, bottom_rad;

  RotaryFigures(const Belief& belief, const Edits& edits) {
    const auto read = [&](const char* key, double otherwise) {
      return edits.edited(key, belief.value(key, otherwise));
    };
    inertia_kg_m2 = std::max(1e-9, read("axis.inertia_kg_m2", 1.0));
    gravity_torque_Nm = read("axis.gravity_torque_Nm", 0.0);
    bottom_rad = read("axis.bottom_rad", 0.0);
    viscous_Nm_s = read("axis.viscous_friction_Nm_s", 0.0);
    coulomb_Nm = read("axis.coulomb_friction_Nm", 0.0);
    switch_speed_radps = std::max(1e-6, read("axis.friction_switch_speed_radps", 0.02));
  }
};

}  // namespace sandhopper::diagnose
