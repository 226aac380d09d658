#pragma once
#include <span>

#include "tools/diagnose/model/context.hpp"
#include "tools/diagnose/model/edits.hpp"
#include "tools/diagnose/model/signal.hpp"

namespace sandhopper::diagnose {

// Parameters of the body, the medium and the bed: numbers of the belief after the edits.
struct FallingFigures {
  double gravity_mps2, mass_kg, area_m2, volume_m3, density_kg_per_m3, drag_coefficient,
      linear_drag_N_s_per_m, buoyancy_factor, added_mass_factor, medium_mps, surface_height_m,
      bed_stiffness_N_per_m;

  FallingFigures(const Belief& belief, const Edits& edits);
};

// Length of a body along its way into a liquid: the diameter of its frontal area, else the cube root of its
// volume, else 5 cm.
double body_length_m(const Belief& belief);

// Wetted share of a body of length L whose lowest point is at a depth in a liquid:
//   w = clamp(depth / L, 0, 1)
// 1 if L is 0: the medium is everywhere.
double wetted_share(double depth_m, double length_m);

// Length of the front of a body. The flow separates there and leaves a cavity behind, so only the front has
// drag.
inline double front_m(double length_m) { return 0.25 * length_m; }

// Motion of a body in a medium, perhaps onto a bed or into a liquid; upward positive:
//   (m + M_a) h'' = -m g + w B rho V g - w_f (1/2 rho A C_d |u| + b) u + M_a'(d) h'^2 + F_bed + laws
//   u = h' - w_m, with the medium's own speed w_m
//   M_a(d) = C_m rho V w(d) + law of "body.added_mass"
// w is wetted_share of the body, w_f of its front, d the depth. The term with M_a' acts only on the way down
// into a liquid.
struct FallingMotion {
  Signal height, velocity, accel;
  double touchdown_s = 0.0;  // time at which the fall reaches the surface
};

// Start of one trial. A *_nuisance is the index of the trial's nuisance that shifts it; -1: none.
struct Fall {
  Belief belief;
  double payload_kg = 0.0;  // set-up value payload_kg
  bool bed = false, held = false;
  double length_m = 0.0;    // length of a body that enters a liquid, else 0
  double surface_m = 0.0;   // height of that liquid's surface
  double to_entry_s = 0.0;  // time from release to entry if the entry is the known instant, else 0
  double start_height_m = 0.0, start_speed_mps = 0.0;
  double end_s = 0.0, step_s = 1e-3;
  double release_s = 0.0;
  double touchdown_s = 0.0;
  double impact_s = -1.0, impact_speed_mps = 0.0;  // >= 0: fall and stop are simulated separately
  int bed_nuisance = -1, release_nuisance = -1, touchdown_nuisance = -1, impact_nuisance = -1;

  // Simulates the trial. The recorded touchdown is fitted as a nuisance, and one more row requires that the
  // fall ends at that time. A fall that is some milliseconds too long then does not spoil the fit of the
  // whole bed phase. `stop`: simulates from the impact on, from its own state.
  FallingMotion simulate(const Edits& edits, std::span<const double> nuisances, bool stop = false) const;
};

}  // namespace sandhopper::diagnose
