#pragma once
#include "estimation/leg.hpp"
#include "estimation/momentum_observer.hpp"

// Ground force from the motor side of the leg alone, for a foot that stands still. With x_f at rest the two
// rows of the leg's equation of motion (estimation/leg.hpp) combine to
//   L' F_c = (M11 L' - M12) g - h phidd + (M12' L' - M22'/2) phid^2 + tau + Q2,   h = M22 - M12 L'.
// The body's mass and all forces on the body (rail friction, cable) cancel. h is the inertia of rotors and
// links, which the motors accelerate besides the body. With massless links F_c = m_f g + (tau + Q2 - J
// phidd)/L'; without rotor inertia J, friction Q2 and the foot's weight this is the quasi-static tau/L'. The
// disadvantage is the second derivative of the angle. The paper's form (M_f, beta, C) does not need it, but
// it needs the body's mass.
namespace sandhopper {

struct JointState {
  double angle_rad;
  double rate_radps;
  double accel_radps2;
};

struct JointFriction {
  double coulomb_Nm = 0.0;    // of all motors together
  double viscous_Nm_s = 0.0;  // of all motors together
  double switch_radps = 0.2;  // Coulomb friction changes sign over this rate: tanh(rate/switch)

  // Friction torque on the joint [N m]; it opposes the motion.
  double torque_Nm(double rate_radps) const noexcept;
};

// F_c [N]. torque_Nm is the sum of all torques on the upper links, friction included.
double joint_row_force_N(const Leg& leg, const JointState& state, double torque_Nm) noexcept;

// F_c [N] from the reduced equation with the foot at rest: M_f g + beta torque + C phid^2.
double reduced_row_force_N(const Leg& leg, const JointState& state, double torque_Nm) noexcept;

// The same force without a second derivative: momentum observer of p = h phid, whose rate is
//   pdot = psi - L' F_c,   psi = (M11 L' - M12) g + tau + Q2 + (M12' L' - M22'/2 + h') phid^2,
// with h' = M22' - M12' L' - M12 L''. It is causal: it estimates the force at the newest sample with a delay
// of 1/gain.
class JointRowObserver {
 public:
  explicit JointRowObserver(double gain_per_s) noexcept : observer_(gain_per_s) {}

  // Starts at this state with the contact force 0.
  void reset(const Leg& leg, double angle_rad, double rate_radps) noexcept;

  // Returns F_c [N]. Angle, rate and torque are the values at the middle of the step that ended now.
  double update(const Leg& leg, double angle_rad, double rate_radps, double torque_Nm, double dt_s) noexcept;

 private:
  MomentumObserver observer_;
};

}  // namespace sandhopper
