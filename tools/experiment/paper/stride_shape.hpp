#pragma once
#include "tools/experiment/paper/hop_trial.hpp"

namespace sandhopper::paper {

// Features of one stance's true motion that the paper's text describes. Times count from physical contact.
// Speeds are positive downward for the foot and upward for the body. NaN if a feature does not exist.
struct StrideShape {
  double touchdown_speed_mps;
  double contact_s;      // time from release to contact
  double compression_s;  // time from contact to switch
  double extension_s;    // time from switch to liftoff
  double rest_s;         // time until the foot is slower than 5 % of its touchdown speed
  double early_peak_N;   // largest local maximum in the first 60 ms
  double early_peak_s;
  double early_drop;       // relative drop of the force after the early peak
  double plateau_s;        // time below 0.02 m/s between two phases of penetration
  double switch_foot_mps;  // at the switch
  double switch_body_mps;  // at the switch
  double shortest_leg_s;   // time of the shortest leg relative to the switch
  double opposed_s;        // time after the switch with the foot moving down and the body up
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
