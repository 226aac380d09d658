#pragma once
#include "tools/plant/world_config.hpp"

// Checks of the leg's mechanics. Each value is computed independently of the code that it checks.
namespace sandhopper::paper {

// A leg that stands on rigid ground with a spring along it, at rest.
struct StaticLeg {
  double quasi_static_N;  // tau / L'
  double spring_N;        // K (L0 - L)
  double contact_N;
  double reduced_weight_N;  // M_f g
};
StaticLeg standing_leg(const WorldConfig& world);

// Largest difference over the leg's angles between the mass matrix (and its derivative) of estimation/leg.hpp
// and one that is assembled from the links' positions by complex-step differentiation. SI units.
double mass_matrix_difference(const LegParameters& leg);

// Largest residual [N] of M_f (xdd + g) = F_c - beta tau - C phid^2 if the two rows of the full equation of
// motion are solved for both accelerations, over random states, forces and torques.
double reduced_equation_residual_N(const LegParameters& leg);

// Remainder F_c - tau/L' for a leg without link and rotor inertia while the foot accelerates with
// `foot_accel_mps2`, and the foot's own m_f (xdd + g).
struct MasslessRemainder {
  double remainder_N;
  double foot_inertia_N;
};
MasslessRemainder massless_remainder(const LegParameters& leg, double foot_accel_mps2);

}  // namespace sandhopper::paper
