#pragma once
#include "tools/terrain/leg_regression.hpp"

// A hop's contact force by each way to estimate it, row by row.
namespace sandhopper {

std::vector<double> quasi_static_force(const LegHop& hop);
std::vector<double> smooth_force(const PreparedHop& prepared, const LegIdentification& found,
                                 const LegIdentificationOptions& options);

// Both causal forms see the angle up to their row only: rate by difference, torque and angle of the middle of
// the step.
struct CausalForces {
  std::vector<double> joint_row_N, reduced_row_N;
};
CausalForces causal_forces(const LegHop& hop, double gain_per_s, const LegIdentification& found,
                           const LegIdentificationOptions& options);

// What an observer of this gain makes of a force it knows exactly.
std::vector<double> behind_lag(const std::vector<double>& force_N, const std::vector<double>& t_s,
                               double gain_per_s);

}  // namespace sandhopper
