#include "tools/terrain/leg_forces.hpp"

#include <cmath>

namespace sandhopper {
namespace {

// The believed leg with the identified parameters.
Leg identified_leg(const LegParameters& believed, const LegIdentification& found) {
  LegParameters p = believed;
  p.rotor_inertia_kg_m2 = found.value[1] / (p.motor_count * p.gear_ratio * p.gear_ratio);
  if (found.mass_kg.trials > 0)
    p.body_mass_kg =
        found.mass_kg.value - p.foot_mass_kg - 2.0 * (p.upper_link_mass_kg + p.lower_link_mass_kg);
  if (!(p.body_mass_kg > 0.0)) p.body_mass_kg = 1.0;
  return Leg{p};
}

JointFriction identified_friction(const LegIdentification& found, const LegIdentificationOptions& options) {
  return {found.value[2], found.value[3], options.friction_switch_radps};
}

// Torque on the joint from the commanded torque, friction and spring.
double joint_torque_Nm(const LegIdentification& found, const JointFriction& friction, double command_Nm,
                       double angle_rad, double rate_radps) {
  return found.value[0] * command_Nm + friction.torque_Nm(rate_radps) + found.spring_torque_Nm -
         found.spring_stiffness_Nm_per_rad * angle_rad;
}

}  // namespace

std::vector<double> smooth_force(const PreparedHop& prepared, const LegIdentification& found,
                                 const LegIdentificationOptions& options) {
  const auto& hop = *prepared.hop;
  const Leg leg = identified_leg(hop.leg, found);
  const auto friction = identified_friction(found, options);
  std::vector<double> out;
  for (std::size_t row = 0; row < hop.t_s.size(); ++row) {
    const auto& state = prepared.state[row];
    out.push_back(joint_row_force_N(
        leg, state, joint_torque_Nm(found, friction, hop.torque_Nm[row], state.angle_rad, state.rate_radps)));
  }
  return out;
}

std::vector<double> quasi_static_force(const LegHop& hop) {
  const Leg leg = bare_leg(hop.leg);
  std::vector<double> out;
  for (std::size_t row = 0; row < hop.t_s.size(); ++row)
    out.push_back(hop.torque_Nm[row] / leg.kinematics(hop.angle_rad[row]).dlength_m_per_rad);
  return out;
}

CausalForces causal_forces(const LegHop& hop, double gain_per_s, const LegIdentification& found,
                           const LegIdentificationOptions& options) {
  const Leg leg = identified_leg(hop.leg, found);
  const auto friction = identified_friction(found, options);
  JointRowObserver joint(gain_per_s);
  MomentumObserver reduced(gain_per_s);  // for a foot at rest, whose momentum is zero
  CausalForces out{{0.0}, {0.0}};
  for (std::size_t row = 1; row < hop.t_s.size(); ++row) {
    const double dt = hop.t_s[row] - hop.t_s[row - 1];
    const double angle = 0.5 * (hop.angle_rad[row] + hop.angle_rad[row - 1]);
    const double rate = (hop.angle_rad[row] - hop.angle_rad[row - 1]) / dt;
    const double command = 0.5 * (hop.torque_Nm[row] + hop.torque_Nm[row - 1]);
    const double torque = joint_torque_Nm(found, friction, command, angle, rate);
    if (row == 1) joint.reset(leg, angle, rate);
    out.joint_row_N.push_back(joint.update(leg, angle, rate, torque, dt));
    const double psi_N = -reduced_row_force_N(leg, {angle, rate, 0.0}, torque);
    out.reduced_row_N.push_back(reduced.update(0.0, psi_N, dt));
  }
  return out;
}

std::vector<double> behind_lag(const std::vector<double>& force_N, const std::vector<double>& t_s,
                               double gain_per_s) {
  std::vector<double> out{0.0};
  for (std::size_t row = 1; row < force_N.size(); ++row) {
    const double keep = std::exp(-gain_per_s * (t_s[row] - t_s[row - 1]));
    out.push_back(keep * out.back() + (1.0 - keep) * 0.5 * (force_N[row] + force_N[row - 1]));
  }
  return out;
}

}  // namespace sandhopper
