#pragma once
#include <span>

#include "tools/diagnose/model/context.hpp"
#include "tools/diagnose/model/edits.hpp"
#include "tools/diagnose/model/signal.hpp"

namespace sandhopper::diagnose {

// Beliefs about a falling body and about the medium and bed that it meets.
struct FallingFigures {
  double gravity_mps2, mass_kg, area_m2, volume_m3, density_kg_per_m3, drag_coefficient,
      linear_drag_N_s_per_m, buoyancy_factor, added_mass_factor, surface_height_m, bed_stiffness_N_per_m;

  FallingFigures(const Belief& belief, const Edits& edits);
};

// A body's length along its way into a liquid, as its frontal area or its volume has it.
double body_length_m(const Belief& belief);

// The share of a body of length L that a liquid wets at a depth of its lowest point:
//   w = clamp(depth / L, 0, 1)
// 1 where L is 0: the medium is all around.
double wetted_share(double depth_m, double length_m);

// Length of the front, from which the flow separates: drag acts on it alone, a cavity lies behind.
inline double front_m(double length_m) { return 0.25 * length_m; }

// Body in a medium, perhaps onto a bed or into a liquid:
//   (m + C_m rho V w + m_a) h'' = -m g + w B rho V g - w_f (1/2 rho A C_d |h'| + b) h' + m_a'(d) h'^2
//                                 + F_bed + laws
// w: wetted_share of the body, w_f: of its front, d the depth, m_a(d) the law of "body.added_mass"; the term
// with m_a' only on the way down.
struct FallingMotion {
  Signal height, velocity, accel;
  double touchdown_s = 0.0;  // when the fall reaches the surface
};

// How one trial began, and which of its nuisances (by index, -1: it has none) move that.
struct Fall {
  Belief belief;
  double payload_kg = 0.0;  // as the experimenter weighed it
  bool bed = false, held = false;
  double length_m = 0.0;    // of a body that meets a liquid, else 0
  double surface_m = 0.0;   // height of that liquid's surface
  double to_entry_s = 0.0;  // from the release on, where the instant of the entry is what is known
  double start_height_m = 0.0, start_speed_mps = 0.0;
  double end_s = 0.0, step_s = 1e-3;
  double release_s = 0.0;
  double touchdown_s = 0.0;
  double impact_s = -1.0, impact_speed_mps = 0.0;  // where fall and stop are simulated apart
  int bed_nuisance = -1, release_nuisance = -1, touchdown_nuisance = -1, impact_nuisance = -1;

  // The instant of touchdown is seen in the recording and fitted on its own; that the fall ends at that
  // instant is one row more. So a fall that is some milliseconds too long does not hide the whole bed from
  // the fit. `stop`: from the impact on, with a state of its own.
  FallingMotion simulate(const Edits& edits, std::span<const double> nuisances, bool stop = false) const;
};

}  // namespace sandhopper::diagnose
