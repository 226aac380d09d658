#pragma once
#include <vector>

#include "tools/experiment/paper/force_map.hpp"
#include "tools/experiment/paper/hop_trial.hpp"

namespace sandhopper::paper {

// Where force and motion of a hop come from.
enum class ForceSource {
  truth,
  instruments,  // load cell; true motion, as motion capture and the foot's IMU give it
  robot         // momentum observer, filter's depth from the first contact on, foot's IMU
};

// One penetrating sample: force, and the force by each description of the actuator set.
struct PenetratingSample {
  double time_s;  // since contact
  double depth_m;
  double speed_mps;  // downward
  double force_N;
  double line_N;     // straight line fitted to this very trial
  double map_N;      // depth-speed map of the actuator set; nothing fitted to the trial
  double inertia_N;  // -m_a(z) a_f, m_a integrated from the map
};

// Samples at new depths while the foot descends; empty where there are fewer than ten.
std::vector<PenetratingSample> penetrating_samples(const HopTrial& trial, const ForceMap& map,
                                                   ForceSource source);

// How well each description explains a trial's penetrating samples.
struct Decomposition {
  double line_rms_N = 0.0;
  double map_rms_N = 0.0;
  double inertial_rms_N = 0.0;  // map plus added mass
  double correlation = 0.0;     // of what the map leaves with the added mass's force
  bool known = false;
};
Decomposition decompose(const std::vector<PenetratingSample>& samples);

}  // namespace sandhopper::paper
