#pragma once
#include <array>

#include "tools/conceal/hopper/leg.hpp"

namespace sandhopper::conceal::hopper {

// State: foot height, leg angle, compression of the foot's spring, rotor angle; their rates; stretch of the
// hysteretic springs of the cable and of the joint.
using State = std::array<double, 10>;
enum : std::size_t {
  kFoot,
  kAngle,
  kSpring,
  kRotor,
  kFootRate,
  kAngleRate,
  kSpringRate,
  kRotorRate,
  kCable,
  kJoint
};

// Contact of the foot with the bed: none, on virgin grains, or above the deepest point (unloading,
// reloading).
enum class Contact { none, virgin, rebound };

// Constants of one trial.
struct Scene {
  const World& world;
  Robot robot;  // with hidden masses and lengths
  double payload_kg = 0.0;
  BedState bed;
  double cable_rest_m = 0.0;  // Body height at which the cable has no force.
  bool clamped = false;       // The body keeps its speed.
};

// Rate of the state, accelerations of body and foot (upward), force of the bed on the foot.
struct Accelerations {
  State slope;
  double body_mps2 = 0.0, foot_mps2 = 0.0;
  double contact_N = 0.0;
};

// Accelerations for a torque (sum of both motors), with the given contact law and bed state.
Accelerations accelerations(const Scene& scene, Contact contact, double t_s, const State& x,
                            double torque_Nm);

// Depth of the foot below the surface; height and speed of the body, upward.
double depth_m(const Scene& scene, const State& x);
double body_height_m(const Scene& scene, const State& x);
double body_speed_mps(const Scene& scene, const State& x);

}  // namespace sandhopper::conceal::hopper
