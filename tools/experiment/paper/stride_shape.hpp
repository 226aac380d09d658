#pragma once
#include "tools/experiment/paper/hop_trial.hpp"

namespace sandhopper::paper {

// Features of one stance's true motion that the paper's text describes. Times count from physical contact,
// speeds are downward for the foot and upward for the body; NaN where a feature is not there.
struct StrideShape {
  double touchdown_speed_mps;
  double contact_s;      // after the release
  double compression_s;  // contact to switch
  double extension_s;    // switch to liftoff
  double rest_s;         // until the foot is slower than 5 % of its touchdown speed
  double early_peak_N;   // largest local maximum of the first 60 ms
  double early_peak_s;
  double early_drop;       // share of the early peak by which the force then falls
  double plateau_s;        // slower than 0.02 m/s between two phases of penetration
  double switch_foot_mps;  // at the switch
  double switch_body_mps;  // at the switch
  double shortest_leg_s;   // shortest leg after the switch (negative: before)
  double opposed_s;        // foot still down, body up, from the switch on
  double peak_force_N;
  double peak_force_s;
  double max_depth_m;
  double max_depth_s;
  double liftoff_depth_m;
  double touchdown_transient_mps2;  // change of the foot's acceleration within 20 ms: up, down, up
  double switch_transient_mps2;
  double liftoff_transient_mps2;
};

// The trial must be complete.
StrideShape stride_shape(const HopTrial& trial);

}  // namespace sandhopper::paper
