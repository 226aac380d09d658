#pragma once
#include <array>
#include <cstddef>
#include <span>

#include "tools/experiment/paper/actuator_set.hpp"

namespace sandhopper::paper {

// Compact depth-speed model of the actuator set, by ordinary least squares over all samples of all runs:
//   F = c0 + k z + (a + b z + c z^2) v^2
// For added mass the coefficient of v^2 is dm_a/dz, so its integral is m_a.
struct ForceMap {
  double intercept_N = 0.0;                  // c0
  double stiffness_N_per_m = 0.0;            // k
  std::array<double, 3> drag_coefficient{};  // a [kg/m], b [kg/m^2], c [kg/m^3]
  double r_squared = 0.0;
  double rms_N = 0.0;
  std::size_t samples = 0;

  double force_N(double depth_m, double speed_mps) const;
  double mass_gradient_kg_per_m(double depth_m) const;
  double added_mass_kg(double depth_m) const;  // integral of the gradient from the surface
};

ForceMap fit_force_map(std::span<const ActuatorRun> runs);

// k_GT [N/m] by each possible definition of "stiffness of the actuator's force-depth curve".
struct StiffnessDefinitions {
  double slow_free_intercept = 0.0;      // mean slope of the runs below the inertial speed sqrt(2 d g)
  double slow_through_origin = 0.0;      // the same, lines through the origin
  double map_coefficient = 0.0;          // k of the map
  double all_runs_free_intercept = 0.0;  // mean slope of all runs
  double fastest_free_intercept = 0.0;   // mean slope of the runs above 1 m/s
  double bed = 0.0;                      // true stiffness of the bed
};
StiffnessDefinitions stiffness_by_definition(std::span<const ActuatorRun> runs, const ForceMap& map,
                                             double bed_stiffness_N_per_m, double inertial_speed_mps);

}  // namespace sandhopper::paper
