#pragma once
#include <array>

#include "tools/conceal/hopper/leg.hpp"

namespace sandhopper::conceal::hopper {

// foot height, leg angle, compression of the foot's spring, rotor angle; their rates; stretch of the cable's
// and of the joint's hysteretic spring.
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

enum class Contact { none, virgin, rebound };

// What is the same throughout a trial.
struct Scene {
  const World& world;
  Robot robot;  // with its hidden masses and lengths
  double payload_kg = 0.0;
  BedState bed;
  double cable_rest_m = 0.0;  // body height at which the cable does not pull
  bool clamped = false;       // the body keeps its speed
};

struct Accelerations {
  State slope;
  double body_mps2 = 0.0, foot_mps2 = 0.0;
  double contact_N = 0.0;
};

// Motion under the motors' torque (both together); contact law and bed memory as given.
Accelerations accelerations(const Scene& scene, Contact contact, double t_s, const State& x,
                            double torque_Nm);

double depth_m(const Scene& scene, const State& x);
double body_height_m(const Scene& scene, const State& x);
double body_speed_mps(const Scene& scene, const State& x);

}  // namespace sandhopper::conceal::hopper
