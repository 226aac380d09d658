#include "estimation/joint_force.hpp"

#include <cmath>

namespace sandhopper {
namespace {

// Coefficients of the phi row of the equation of motion (joint_force.hpp) at one angle.
struct JointRow {
  double dlength_m_per_rad;   // L'
  double inertia_kg_m2;       // h
  double dinertia_kg_m2;      // h', per rad
  double weight_Nm;           // (M11 L' - M12) g
  double rate_squared_kg_m2;  // M12' L' - M22'/2
};

JointRow joint_row(const Leg& leg, double angle_rad) noexcept {
  const auto d = leg.dynamics(angle_rad);
  const double dl = d.leg.dlength_m_per_rad;
  return {.dlength_m_per_rad = dl,
          .inertia_kg_m2 = d.m22_kg_m2 - d.m12_kg_m * dl,
          .dinertia_kg_m2 =
              d.dm22_kg_m2_per_rad - d.dm12_kg_m_per_rad * dl - d.m12_kg_m * d.leg.d2length_m_per_rad2,
          .weight_Nm = (d.m11_kg * dl - d.m12_kg_m) * kGravity_mps2,
          .rate_squared_kg_m2 = d.dm12_kg_m_per_rad * dl - d.dm22_kg_m2_per_rad / 2.0};
}

}  // namespace

double JointFriction::torque_Nm(double rate_radps) const noexcept {
  return -coulomb_Nm * std::tanh(rate_radps / switch_radps) - viscous_Nm_s * rate_radps;
}

double joint_row_force_N(const Leg& leg, const JointState& state, double torque_Nm) noexcept {
  const auto row = joint_row(leg, state.angle_rad);
  return (row.weight_Nm + torque_Nm - row.inertia_kg_m2 * state.accel_radps2 +
          row.rate_squared_kg_m2 * state.rate_radps * state.rate_radps) /
         row.dlength_m_per_rad;
}

double reduced_row_force_N(const Leg& leg, const JointState& state, double torque_Nm) noexcept {
  const auto d = leg.dynamics(state.angle_rad);
  return d.reduced_mass_kg * kGravity_mps2 + d.torque_gain_per_m * torque_Nm +
         d.coriolis_N_s2_per_rad2 * state.rate_radps * state.rate_radps;
}

void JointRowObserver::reset(const Leg& leg, double angle_rad, double rate_radps) noexcept {
  observer_.reset(joint_row(leg, angle_rad).inertia_kg_m2 * rate_radps);
}

double JointRowObserver::update(const Leg& leg, double angle_rad, double rate_radps, double torque_Nm,
                                double dt_s) noexcept {
  const auto row = joint_row(leg, angle_rad);
  const double psi_Nm =
      row.weight_Nm + torque_Nm + (row.rate_squared_kg_m2 + row.dinertia_kg_m2) * rate_radps * rate_radps;
  const double ground_Nm = observer_.update(row.inertia_kg_m2 * rate_radps, psi_Nm, dt_s);
  return -ground_Nm / row.dlength_m_per_rad;
}

}  // namespace sandhopper
