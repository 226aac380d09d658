#pragma once
#include "tools/conceal/hopper/world.hpp"

namespace sandhopper::conceal::hopper {

// A quantity with its first and second derivative by the angle phi of the upper link.
struct Curve {
  double value = 0.0, first = 0.0, second = 0.0;
};

// The leg at one angle: height of the hip above the toe, and the sums in Kane's equations. A body i with mass
// m_i at (X_i, Z_i) above the toe and with angle a_i depends on the toe's motion and on phi only:
//   mass = sum m_i      first = sum m_i Z_i'      second = sum m_i (Z_i'^2 + X_i'^2) + I_i a_i'^2
//   first_rate  = sum m_i Z_i''       second_rate = sum m_i (Z_i' Z_i'' + X_i' X_i'') + I_i a_i' a_i''
struct Leg {
  Curve hip_m;
  double mass_kg = 0.0, first_kg_m = 0.0, second_kg_m2 = 0.0, first_rate_kg_m = 0.0, second_rate_kg_m2 = 0.0;
};

// Two links on each side, both sides alike. `payload_kg` is fixed to the body. The rotors are not included.
Leg leg_at(const Robot& robot, double payload_kg, double angle_rad);

// Height of the hip above the toe, m, and its derivatives.
Curve hip_over_toe(const Robot& robot, double angle_rad);
// Angle of the upper link for a height of the hip above the toe.
double angle_for(const Robot& robot, double hip_over_toe_m);

}  // namespace sandhopper::conceal::hopper
