#pragma once
#include "tools/terrain/leg_regression.hpp"

// Contact force of a hop by each estimation method, row by row.
namespace sandhopper {

std::vector<double> quasi_static_force(const LegHop& hop);
std::vector<double> smooth_force(const PreparedHop& prepared, const LegIdentification& found,
                                 const LegIdentificationOptions& options);

// Both causal methods use the angle only up to their row. The rate is a difference; torque and angle are
// those at the middle of the step.
struct CausalForces {
  std::vector<double> joint_row_N, reduced_row_N;
};
CausalForces causal_forces(const LegHop& hop, double gain_per_s, const LegIdentification& found,
                           const LegIdentificationOptions& options);

// Output of an observer with this gain for an exactly known force.
std::vector<double> behind_lag(const std::vector<double>& force_N, const std::vector<double>& t_s,
                               double gain_per_s);

}  // namespace sandhopper
