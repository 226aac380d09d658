#include "estimation/leg.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sandhopper {

Leg::Leg(const LegParameters& parameters)
    : p_(parameters),
      lower_com_to_toe_m_(p_.lower_link_length_m - p_.lower_link_com_m),
      total_mass_kg_(p_.body_mass_kg + p_.foot_mass_kg +
                     2.0 * (p_.upper_link_mass_kg + p_.lower_link_mass_kg)),
      rotor_inertia_total_kg_m2_(p_.motor_count * p_.rotor_inertia_kg_m2 * p_.gear_ratio * p_.gear_ratio) {
  if (p_.lower_link_length_m <= p_.upper_link_length_m + p_.hip_offset_m)
    throw std::invalid_argument(
        "leg: lower_link_length_m must exceed upper_link_length_m + hip_offset_m, or the leg locks at pi/2");
  if (!(dynamics(1.2).m22_kg_m2 > 0.0))
    throw std::invalid_argument(
        "leg: body, link and rotor inertia are all zero, so no torque has a finite response");
}

namespace {

// Sines and cosines of both links, and the lower link's angle psi from the vertical with its derivatives in
// phi.
struct LinkAngles {
  double s, c, sin_psi, cos_psi, dpsi, d2psi;
};

LinkAngles link_angles(const LegParameters& p, double angle_rad) noexcept {
  const double s = std::sin(angle_rad);
  const double c = std::cos(angle_rad);
  const double l1 = p.upper_link_length_m;
  const double l2 = p.lower_link_length_m;
  const double sin_psi = (p.hip_offset_m + l1 * s) / l2;
  const double cos_psi = std::sqrt(1.0 - sin_psi * sin_psi);
  const double dpsi = l1 * c / (l2 * cos_psi);
  const double d2psi = (-l1 * s + l2 * sin_psi * dpsi * dpsi) / (l2 * cos_psi);
  return {s, c, sin_psi, cos_psi, dpsi, d2psi};
}

LegKinematics kinematics_of(const LegParameters& p, const LinkAngles& a) noexcept {
  const double l1 = p.upper_link_length_m;
  const double l2 = p.lower_link_length_m;
  return {.length_m = l1 * a.c + l2 * a.cos_psi,
          .dlength_m_per_rad = -l1 * a.s - l2 * a.sin_psi * a.dpsi,
          .d2length_m_per_rad2 = -l1 * a.c - l2 * (a.cos_psi * a.dpsi * a.dpsi + a.sin_psi * a.d2psi)};
}

}  // namespace

LegKinematics Leg::kinematics(double angle_rad) const noexcept {
  return kinematics_of(p_, link_angles(p_, angle_rad));
}

LegDynamics Leg::dynamics(double angle_rad) const noexcept {
  const auto [s, c, sin_psi, cos_psi, dpsi, d2psi] = link_angles(p_, angle_rad);

  LegDynamics d{};
  d.leg = kinematics_of(p_, {s, c, sin_psi, cos_psi, dpsi, d2psi});
  const double dl = d.leg.dlength_m_per_rad;
  const double d2l = d.leg.d2length_m_per_rad2;
  const double m_b = p_.body_mass_kg;
  const double m1 = p_.upper_link_mass_kg;
  const double m2 = p_.lower_link_mass_kg;
  const double c1 = p_.upper_link_com_m;
  const double e2 = lower_com_to_toe_m_;
  const double upper_vertical = dl + c1 * s;  // d(height of the upper link's centre)/dphi
  const double upper_horizontal = c1 * c;
  const double lower_inertia = m2 * e2 * e2 + p_.lower_link_inertia_kg_m2;  // about the toe joint

  d.m11_kg = total_mass_kg_;
  d.m12_kg_m = m_b * dl + 2.0 * m1 * upper_vertical - 2.0 * m2 * e2 * sin_psi * dpsi;
  d.m22_kg_m2 =
      m_b * dl * dl + 2.0 * m1 * (upper_vertical * upper_vertical + upper_horizontal * upper_horizontal) +
      2.0 * p_.upper_link_inertia_kg_m2 + rotor_inertia_total_kg_m2_ + 2.0 * lower_inertia * dpsi * dpsi;
  d.dm12_kg_m_per_rad =
      (m_b + 2.0 * m1) * d2l + 2.0 * m1 * c1 * c - 2.0 * m2 * e2 * (cos_psi * dpsi * dpsi + sin_psi * d2psi);
  d.dm22_kg_m2_per_rad = 2.0 * m_b * dl * d2l +
                         2.0 * m1 * (2.0 * upper_vertical * (d2l + c1 * c) - 2.0 * c1 * c1 * s * c) +
                         4.0 * lower_inertia * dpsi * d2psi;
  d.torque_gain_per_m = d.m12_kg_m / d.m22_kg_m2;
  const double beta = d.torque_gain_per_m;
  d.reduced_mass_kg = d.m11_kg - d.m12_kg_m * beta;
  d.coriolis_N_s2_per_rad2 = d.dm12_kg_m_per_rad - beta * d.dm22_kg_m2_per_rad / 2.0;
  d.dreduced_mass_kg_per_rad = -2.0 * beta * d.dm12_kg_m_per_rad + beta * beta * d.dm22_kg_m2_per_rad;
  return d;
}

double Leg::angle_at_length(double length_m) const noexcept {
  double angle = 1.0;
  for (int i = 0; i < 40; ++i) {
    const auto k = kinematics(angle);
    const double step = (k.length_m - length_m) / k.dlength_m_per_rad;
    angle = std::clamp(angle - step, 1e-3, 3.0);
    if (std::abs(step) < 1e-15) break;
  }
  return angle;
}

double mechanical_energy_J(const Leg& leg, double foot_z_m, double foot_velocity_mps, double angle_rad,
                           double angular_velocity_radps) noexcept {
  const auto d = leg.dynamics(angle_rad);
  const auto& p = leg.parameters();
  const double l1 = p.upper_link_length_m;
  const double c = std::cos(angle_rad);
  const double cos_psi = (d.leg.length_m - l1 * c) / p.lower_link_length_m;
  const double toe_z = foot_z_m + p.foot_height_m;
  const double body_z = toe_z + d.leg.length_m;
  const double upper_com_z = body_z - p.upper_link_com_m * c;
  const double lower_com_z = toe_z + (p.lower_link_length_m - p.lower_link_com_m) * cos_psi;
  const double potential =
      kGravity_mps2 * (p.body_mass_kg * body_z + p.foot_mass_kg * foot_z_m +
                       2.0 * p.upper_link_mass_kg * upper_com_z + 2.0 * p.lower_link_mass_kg * lower_com_z);
  const double kinetic = 0.5 * d.m11_kg * foot_velocity_mps * foot_velocity_mps +
                         d.m12_kg_m * foot_velocity_mps * angular_velocity_radps +
                         0.5 * d.m22_kg_m2 * angular_velocity_radps * angular_velocity_radps;
  return kinetic + potential;
}

}  // namespace sandhopper
