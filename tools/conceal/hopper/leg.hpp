#pragma once
#include "tools/conceal/hopper/world.hpp"

namespace sandhopper::conceal::hopper {

// Height and width of a point above the toe joint, with first and second derivative by the upper link's
// angle.
struct Curve {
  double value = 0.0, first = 0.0, second = 0.0;
};

// The leg at one angle: hip height over the toe, and the sums that Kane's equations need. A body i of mass
// m_i at (X_i, Z_i) over the toe and of angle a_i moves with the toe and the angle phi alone:
//   mass = sum m_i      first = sum m_i Z_i'      second = sum m_i (Z_i'^2 + X_i'^2) + I_i a_i'^2
//   first_rate  = sum m_i Z_i''       second_rate = sum m_i (Z_i' Z_i'' + X_i' X_i'') + I_i a_i' a_i''
struct Leg {
  Curve hip_m;
  double mass_kg = 0.0, first_kg_m = 0.0, second_kg_m2 = 0.0, first_rate_kg_m = 0.0, second_rate_kg_m2 = 0.0;
};

// Two links a side, both sides alike; `payload_kg` sits on the body. The rotors are not in it.
Leg leg_at(const Robot& robot, double payload_kg, double angle_rad);

// Hip height over the toe and its derivative, for the controller.
Curve hip_over_toe(const Robot& robot, double angle_rad);
double angle_for(const Robot& robot, double hip_over_toe_m);

}  // namespace sandhopper::conceal::hopper
