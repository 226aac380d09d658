#include "tools/experiment/paper/leg_checks.hpp"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <complex>

#include "tools/plant/plant.hpp"
#include "tools/plant/random.hpp"

namespace sandhopper::paper {
namespace {

using Complex = std::complex<double>;
constexpr double kComplexStep = 1e-30;

// Visits the angles at which the leg is compared: the whole working range.
template <class Visit>
void over_angles(Visit&& visit) {
  for (int i = 0; i <= 42; ++i) visit(0.3 + 0.05 * i);
}

// Heights over the foot's sole and horizontal positions of the moving masses of one side, and the link
// angles.
struct Places {
  Complex body_z, upper_z, upper_x, lower_z, lower_x, lower_angle;
};

Places places(const LegParameters& p, Complex angle) {
  const Complex lower_angle =
      std::asin((p.hip_offset_m + p.upper_link_length_m * std::sin(angle)) / p.lower_link_length_m);
  const Complex length =
      p.upper_link_length_m * std::cos(angle) + p.lower_link_length_m * std::cos(lower_angle);
  const double from_toe = p.lower_link_length_m - p.lower_link_com_m;
  return {.body_z = length,
          .upper_z = length - p.upper_link_com_m * std::cos(angle),
          .upper_x = p.hip_offset_m + p.upper_link_com_m * std::sin(angle),
          .lower_z = from_toe * std::cos(lower_angle),
          .lower_x = from_toe * std::sin(lower_angle),
          .lower_angle = lower_angle};
}

// Mass matrix from the kinetic energy of both sides, links and rotors.
Eigen::Matrix2d mass_matrix(const LegParameters& p, double angle_rad) {
  const auto at = places(p, Complex(angle_rad, kComplexStep));
  const auto rate = [](const Complex& place) { return place.imag() / kComplexStep; };
  const auto square = [](double x) { return x * x; };
  const double upper = 2.0 * p.upper_link_mass_kg;
  const double lower = 2.0 * p.lower_link_mass_kg;
  const double rotors = p.motor_count * p.rotor_inertia_kg_m2 * square(p.gear_ratio);
  Eigen::Matrix2d m;
  m(0, 0) = p.body_mass_kg + p.foot_mass_kg + upper + lower;
  m(0, 1) = m(1, 0) = p.body_mass_kg * rate(at.body_z) + upper * rate(at.upper_z) + lower * rate(at.lower_z);
  m(1, 1) = p.body_mass_kg * square(rate(at.body_z)) +
            upper * (square(rate(at.upper_z)) + square(rate(at.upper_x))) +
            lower * (square(rate(at.lower_z)) + square(rate(at.lower_x))) + 2.0 * p.upper_link_inertia_kg_m2 +
            2.0 * p.lower_link_inertia_kg_m2 * square(rate(at.lower_angle)) + rotors;
  return m;
}

}  // namespace

double mass_matrix_difference(const LegParameters& parameters) {
  const Leg leg(parameters);
  constexpr double kStep_rad = 1e-4;
  double largest = 0.0;
  over_angles([&](double angle_rad) {
    const auto d = leg.dynamics(angle_rad);
    const auto m = mass_matrix(parameters, angle_rad);
    // Fourth-order central difference.
    const Eigen::Matrix2d slope = (8.0 * (mass_matrix(parameters, angle_rad + kStep_rad) -
                                          mass_matrix(parameters, angle_rad - kStep_rad)) -
                                   (mass_matrix(parameters, angle_rad + 2 * kStep_rad) -
                                    mass_matrix(parameters, angle_rad - 2 * kStep_rad))) /
                                  (12.0 * kStep_rad);
    for (const double difference : {d.m11_kg - m(0, 0), d.m12_kg_m - m(0, 1), d.m22_kg_m2 - m(1, 1),
                                    d.dm12_kg_m_per_rad - slope(0, 1), d.dm22_kg_m2_per_rad - slope(1, 1)})
      largest = std::max(largest, std::abs(difference));
  });
  return largest;
}

double reduced_equation_residual_N(const LegParameters& parameters) {
  const Leg leg(parameters);
  Random random(1, 0);
  double largest_N = 0.0;
  over_angles([&](double angle_rad) {
    const auto d = leg.dynamics(angle_rad);
    const double rate = 10.0 * random.normal();
    const double contact_N = 50.0 * random.uniform();
    const double torque_Nm = 4.0 * random.normal();
    Eigen::Matrix2d m;
    m << d.m11_kg, d.m12_kg_m, d.m12_kg_m, d.m22_kg_m2;
    const Eigen::Vector2d right(
        contact_N - d.dm12_kg_m_per_rad * rate * rate - d.m11_kg * kGravity_mps2,
        torque_Nm - d.dm22_kg_m2_per_rad * rate * rate / 2.0 - d.m12_kg_m * kGravity_mps2);
    const Eigen::Vector2d accel = m.fullPivLu().solve(right);
    const double residual_N = d.reduced_mass_kg * (accel(0) + kGravity_mps2) - contact_N +
                              d.torque_gain_per_m * torque_Nm + d.coriolis_N_s2_per_rad2 * rate * rate;
    largest_N = std::max(largest_N, std::abs(residual_N));
  });
  return largest_N;
}

MasslessRemainder massless_remainder(const LegParameters& parameters, double foot_accel_mps2) {
  LegParameters p = parameters;
  p.upper_link_mass_kg = p.lower_link_mass_kg = 0.0;
  p.upper_link_inertia_kg_m2 = p.lower_link_inertia_kg_m2 = p.rotor_inertia_kg_m2 = 0.0;
  const auto d = Leg(p).dynamics(1.2);
  constexpr double kTorque_Nm = -3.0;
  constexpr double kRate_radps = 4.0;
  const double contact_N = d.reduced_mass_kg * (foot_accel_mps2 + kGravity_mps2) +
                           d.torque_gain_per_m * kTorque_Nm +
                           d.coriolis_N_s2_per_rad2 * kRate_radps * kRate_radps;
  return {.remainder_N = contact_N - kTorque_Nm / d.leg.dlength_m_per_rad,
          .foot_inertia_N = p.foot_mass_kg * (foot_accel_mps2 + kGravity_mps2)};
}

StaticLeg standing_leg(const WorldConfig& config) {
  WorldConfig world = config;
  world.terrain.rigid = true;
  world.robot.rail_coulomb_N = world.robot.joint_coulomb_Nm = world.robot.cogging_amplitude_Nm = 0.0;
  Plant plant(world, Bed(world.terrain, world.robot.leg.foot_radius_m));
  const auto& spring = world.controller;
  plant.place({.angle_rad = plant.leg().angle_at_length(spring.compression_length_m)});
  const auto force_N = [&](double damping_N_s_per_m) {
    const auto leg = plant.leg().kinematics(plant.state().angle_rad);
    return spring.extension_stiffness_N_per_m * (spring.compression_length_m - leg.length_m) -
           damping_N_s_per_m * leg.dlength_m_per_rad * plant.state().angular_velocity_radps;
  };
  const auto torque_Nm = [&](double damping_N_s_per_m) {
    return force_N(damping_N_s_per_m) * plant.leg().kinematics(plant.state().angle_rad).dlength_m_per_rad;
  };
  constexpr double kSettle_s = 3.0;
  constexpr double kDamping_N_s_per_m = 60.0;
  for (int i = 0; i < static_cast<int>(kSettle_s / Plant::kStep_s); ++i)
    plant.step(torque_Nm(kDamping_N_s_per_m));
  const auto d = plant.leg().dynamics(plant.state().angle_rad);
  const double torque = torque_Nm(0.0);
  return {.quasi_static_N = torque / d.leg.dlength_m_per_rad,
          .spring_N = force_N(0.0),
          .contact_N = plant.motion(torque).contact_force_N,
          .reduced_weight_N = d.reduced_mass_kg * world.gravity_mps2};
}

}  // namespace sandhopper::paper
