#pragma once
#include <vector>

#include "tools/experiment/paper/force_map.hpp"
#include "tools/experiment/paper/hop_trial.hpp"

namespace sandhopper::paper {

// Source of force and motion of a hop.
enum class ForceSource {
  truth,
  instruments,  // load cell; true motion, as measured by motion capture and the foot's IMU
  robot         // momentum observer, depth of the filter from first contact on, foot's IMU
};

// One penetrating sample: its force, and the force according to each description from the actuator set.
struct PenetratingSample {
  double time_s;  // since contact
  double depth_m;
  double speed_mps;  // downward
  double force_N;
  double line_N;     // straight line fitted to this trial
  double map_N;      // depth-speed map of the actuator set; not fitted to the trial
  double inertia_N;  // -m_a(z) a_f, m_a integrated from the map
};

// Samples at new depths while the foot descends. Empty for fewer than ten.
std::vector<PenetratingSample> penetrating_samples(const HopTrial& trial, const ForceMap& map,
                                                   ForceSource source);

// Residuals of each description for a trial's penetrating samples.
struct Decomposition {
  double line_rms_N = 0.0;
  double map_rms_N = 0.0;
  double inertial_rms_N = 0.0;  // map plus added mass
  double correlation = 0.0;     // between the map's residual and the added-mass force
  bool known = false;
};
Decomposition decompose(const std::vector<PenetratingSample>& samples);

}  // namespace sandhopper::paper
