#pragma once
#include <vector>

#include "tools/conceal/core/keys.hpp"
#include "tools/conceal/core/random.hpp"

namespace sandhopper::conceal {

// A granular bed under a round flat foot: parameters of the nominal law (stiffness, intercept, added mass,
// drag, unloading line) and of the hidden effects. Depth z (m) and speed v (m/s) are positive downward.
struct Bed {
  double stiffness_N_per_m = 1500.0, intercept_depth_m = 3e-3, intercept_growth_depth_m = 3e-3;
  double per_area_N_per_m3 = 0.0, exponent = 1.0;  // If positive, they replace the three above.
  double bulk_density_kg_per_m3 = 1450.0, foot_radius_m = 0.04;
  double added_mass_factor = 1.0, drag_factor = 1.0;
  double recruitment = 2.0, band_angle_deg = 60.0, steady_drag_coefficient = 0.0;
  double unloading_stiffness_ratio = 30.0, unloading_damping_ratio = 0.6, switch_speed_mps = 5e-3;

  struct Hidden {
    double added_mass_kg = 0.0, added_mass_depth_m = 0.014;  // m (1 - exp(-z/depth))
    double quadratic_N_s2_per_m2 = 0.0, viscous_N_s_per_m = 0.0;
    double exponent_excess = 0.0;
    double floor_stiffening = 0.0;
    double unloading_softer = 0.0;  // The stiffness ratio is divided by 1 + this.
    double suction_N = 0.0, crust_N = 0.0, crust_depth_m = 3e-3;
    double compaction = 0.0, compaction_pushes = 2.0, crater_m_per_push = 0.0;
    double strengthening = 0.0;
    double coupling = 0.0, coupling_speed_mps = 0.3;
    double tilt_depth_m = 0.0;
    double weakening = 0.0, weakening_at_mps = 0.4, weakening_width_mps = 0.15;
    double ripple_N = 0.0, ripple_length_m = 6e-3;
    double layer_N = 0.0, layer_at_m = 0.02, layer_width_m = 4e-3;
    double shaken = 0.0, shaken_s = 0.03;  // softer just after the impact
  } hidden;

  double area_m2() const;
};

// State of the bed in one trial: drawn values and memory of earlier loads.
struct BedState {
  double stiffness_relative = 0.0;
  double surface_m = 0.0;
  double bed_depth_m = 0.15;        // depth of the fill below the surface
  double wait_s = 0.0;              // since the bed was prepared, s
  int pushes = 0;                   // completed since it was prepared
  std::vector<double> fluctuation;  // Relative change of the force on a grid of depth (kFluctuationGrid_m).
  double deepest_m = 0.0;           // deepest point so far: plastic memory
  double touched_s = 0.0;           // time of the last touchdown
};

// Step of the grid of BedState::fluctuation.
constexpr double kFluctuationGrid_m = 5e-4;

// Force on virgin grains = steady_N + moving_mass_kg x acceleration (down positive).
struct VirginForce {
  double steady_N;
  double moving_mass_kg;
};

// Quasi-static force at depth z, N, with hidden effects.
double static_N(const Bed& bed, const BedState& state, double z_m);
// The same without hidden effects: a measure for the size of one, whatever else is hidden.
double believed_static_N(Bed bed, double z_m);
// Force on virgin grains at depth z and downward speed v.
VirginForce virgin(const Bed& bed, const BedState& state, double t_s, double z_m, double v_mps);
// Force above the deepest point so far (unloading and reloading), N. `damped_mass_kg`: mass for the damping
// ratio, 0 for no damping.
double rebound_N(const Bed& bed, const BedState& state, double z_m, double v_mps, double damped_mass_kg);

// Ornstein-Uhlenbeck process on the grid of depth, correlation length 2 mm.
std::vector<double> draw_fluctuation(double relative_rms, Random random);
// Keys of [terrain] in nominal.toml.
Json terrain_keys(const Bed& bed);

}  // namespace sandhopper::conceal
