#include "tools/conceal/hopper/dynamics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandhopper::conceal::hopper {
namespace {

constexpr double kPi = std::numbers::pi;
// Stiffness of gear teeth in contact, both motors together.
constexpr double kGearStiffness_Nm_per_rad = 400.0;
constexpr double kGearDamping_Nm_s = 0.3;
constexpr double kSpringDampingRatio = 0.08;

double smooth_sign(double v, double width) { return 2.0 / kPi * std::atan(v / width); }

// Rate of the stretch of an elastoplastic spring: it follows the motion v and yields gradually.
double stretch_rate(double v, double stretch, double yield) {
  const double load = stretch / yield;
  return v - std::abs(v) * load * std::abs(load);
}

double rail_N(const Scene& s, const State& x, double height_m, double speed_mps, double leg_N) {
  const auto& r = s.world.robot;
  const auto& h = s.world.hidden;
  double force = -r.rail_coulomb_N * std::tanh(speed_mps / 0.01) - r.rail_viscous_N_s_per_m * speed_mps;
  const double slow = speed_mps / h.stribeck_mps, off = (height_m - h.bump_at_m) / h.bump_width_m;
  double friction = h.rail_coulomb_N + h.stribeck_N / (1.0 + slow * slow) +
                    h.rail_per_load * std::abs(leg_N) + h.bump_N * std::exp(-off * off);
  if (h.rail_tilt_rad != 0.0)
    friction += 0.1 * 2.3 * s.world.gravity_mps2 * std::sin(std::abs(h.rail_tilt_rad));
  force -= friction * smooth_sign(speed_mps, 4e-3) + h.rail_viscous_N_s_per_m * speed_mps;
  return force - h.cable_N_per_m * (height_m - s.cable_rest_m) - h.cable_N * x[kCable] / h.cable_slack_m;
}

double joint_Nm(const Scene& s, const State& x) {
  const auto& r = s.world.robot;
  const auto& h = s.world.hidden;
  const double angle = x[kAngle], rate = x[kAngleRate];
  double torque = -2.0 * r.joint_coulomb_Nm * std::tanh(rate / 0.2) +
                  2.0 * r.cogging_Nm * std::sin(r.cogging_per_rev * angle) +
                  200.0 * (std::max(0.0, 0.25 - angle) - std::max(0.0, angle - 2.6));
  torque -= 2.0 * (h.joint_coulomb_Nm * smooth_sign(rate, 0.1) + h.joint_viscous_Nm_s * rate);
  torque += 2.0 * h.cogging_Nm * std::sin(h.cogging_per_rev * angle + h.cogging_phase_rad);
  const double off = (angle - h.magnet_at_rad) / h.magnet_width_rad;
  torque -= h.magnet_Nm * off * std::exp(0.5 * (1.0 - off * off));
  return torque - h.spring_Nm_per_rad * x[kJoint];
}

// Solves a x = b in place for the first n unknowns, with pivoting.
void solve(double (&a)[4][4], double (&b)[4], int n) {
  for (int i = 0; i < n; ++i) {
    int pivot = i;
    for (int k = i + 1; k < n; ++k)
      if (std::abs(a[k][i]) > std::abs(a[pivot][i])) pivot = k;
    std::swap(a[i], a[pivot]);
    std::swap(b[i], b[pivot]);
    for (int k = i + 1; k < n; ++k) {
      const double f = a[k][i] / a[i][i];
      for (int j = i; j < n; ++j) a[k][j] -= f * a[i][j];
      b[k] -= f * b[i];
    }
  }
  for (int i = n - 1; i >= 0; --i) {
    for (int j = i + 1; j < n; ++j) b[i] -= a[i][j] * b[j];
    b[i] /= a[i][i];
  }
}

struct Load {
  double rail_N, joint_Nm, ground_N, moving_kg;
};

struct Solution {
  double foot, angle, spring;
};

// Kane's equations for foot, leg angle and the foot's spring, if there is one. For a clamped body the holding
// force of the rail is a further unknown, and zero acceleration of the body a further equation.
Solution solve_motion(const Scene& s, const Leg& leg, const State& x, const Load& load) {
  const double g = s.world.gravity_mps2 * std::cos(s.world.hidden.rail_tilt_rad);
  const double rate2 = x[kAngleRate] * x[kAngleRate];
  const bool sprung = s.world.hidden.series_N_per_m > 0.0, geared = s.world.hidden.backlash_rad > 0.0;
  const double rotors = geared ? 0.0 : 2.0 * s.robot.rotor_kg_m2;
  const double total_kg = s.robot.foot_kg + leg.mass_kg;
  const double first_N = leg.first_rate_kg_m * rate2, foot_z = leg.mass_kg;
  double a[4][4] = {{total_kg + load.moving_kg, leg.first_kg_m, -foot_z, -1.0},
                    {leg.first_kg_m, leg.second_kg_m2 + rotors, -leg.first_kg_m, -leg.hip_m.first},
                    {-foot_z, -leg.first_kg_m, foot_z, 1.0},
                    {1.0, leg.hip_m.first, -1.0, 0.0}};
  double b[4] = {
      load.ground_N + load.rail_N - total_kg * g - first_N,
      load.joint_Nm + load.rail_N * leg.hip_m.first - leg.first_kg_m * g - leg.second_rate_kg_m2 * rate2,
      foot_z * g - load.rail_N + first_N, -leg.hip_m.second * rate2};
  if (sprung) {
    const double k = s.world.hidden.series_N_per_m;
    b[2] -= k * x[kSpring] + 2.0 * kSpringDampingRatio * std::sqrt(k * s.robot.foot_kg) * x[kSpringRate];
  } else {
    for (int i = 0; i < 4; ++i) a[2][i] = a[i][2] = 0.0;
    a[2][2] = 1.0, b[2] = 0.0;
  }
  solve(a, b, s.clamped ? 4 : 3);
  return {b[0], b[1], b[2]};
}

double reduced_foot_mass_kg(const Scene& s, const Leg& leg) {
  const double m22 = leg.second_kg_m2 + 2.0 * s.robot.rotor_kg_m2;
  return s.robot.foot_kg + leg.mass_kg - leg.first_kg_m * leg.first_kg_m / m22;
}

}  // namespace

double depth_m(const Scene& s, const State& x) { return s.bed.surface_m - x[kFoot]; }

double body_height_m(const Scene& s, const State& x) {
  return x[kFoot] + s.robot.foot_height_m - x[kSpring] + hip_over_toe(s.robot, x[kAngle]).value;
}

double body_speed_mps(const Scene& s, const State& x) {
  return x[kFootRate] - x[kSpringRate] + hip_over_toe(s.robot, x[kAngle]).first * x[kAngleRate];
}

Accelerations accelerations(const Scene& s, Contact contact, double t_s, const State& x, double torque_Nm) {
  const auto& h = s.world.hidden;
  const auto leg = leg_at(s.robot, s.payload_kg, x[kAngle]);
  const double body_m = x[kFoot] + s.robot.foot_height_m - x[kSpring] + leg.hip_m.value;
  const double body_mps = x[kFootRate] - x[kSpringRate] + leg.hip_m.first * x[kAngleRate];
  const double z = depth_m(s, x), v = -x[kFootRate];

  // With backlash the torque acts through the gear teeth; otherwise rotor and link are one body.
  double link_Nm = torque_Nm, rotor_mps2 = 0.0;
  if (h.backlash_rad > 0.0) {
    const double play = x[kRotor] - x[kAngle], half = 0.5 * h.backlash_rad;
    const double pressed = play > half ? play - half : play < -half ? play + half : 0.0;
    link_Nm = kGearStiffness_Nm_per_rad * pressed +
              (pressed != 0.0 ? kGearDamping_Nm_s * (x[kRotorRate] - x[kAngleRate]) : 0.0);
    rotor_mps2 = (torque_Nm - link_Nm) / (2.0 * s.robot.rotor_kg_m2);
  }
  Load load{rail_N(s, x, body_m, body_mps, link_Nm / leg.hip_m.first), link_Nm + joint_Nm(s, x), 0.0, 0.0};
  if (contact == Contact::virgin && z > 0.0) {
    const auto force = virgin(s.world.bed, s.bed, t_s, z, v);
    load.ground_N = force.steady_N, load.moving_kg = force.moving_mass_kg;
  } else if (contact == Contact::rebound && z > 0.0) {
    load.ground_N = rebound_N(s.world.bed, s.bed, z, v, reduced_foot_mass_kg(s, leg));
  }
  auto solution = solve_motion(s, leg, x, load);
  double ground_N = load.ground_N - load.moving_kg * solution.foot;
  if (ground_N < 0.0 && contact == Contact::virgin) {  // Grains do not pull on the way down.
    load.ground_N = load.moving_kg = ground_N = 0.0;
    solution = solve_motion(s, leg, x, load);
  }
  Accelerations out;
  const double rotor = h.backlash_rad > 0.0 ? rotor_mps2 : solution.angle;
  const double rotor_rate = h.backlash_rad > 0.0 ? x[kRotorRate] : x[kAngleRate];
  out.slope = {x[kFootRate],
               x[kAngleRate],
               x[kSpringRate],
               rotor_rate,
               solution.foot,
               solution.angle,
               solution.spring,
               rotor,
               stretch_rate(body_mps, x[kCable], h.cable_slack_m),
               stretch_rate(x[kAngleRate], x[kJoint], h.spring_yield_rad)};
  out.foot_mps2 = solution.foot;
  out.body_mps2 = solution.foot - solution.spring + leg.hip_m.first * solution.angle +
                  leg.hip_m.second * x[kAngleRate] * x[kAngleRate];
  out.contact_N = ground_N;
  return out;
}

}  // namespace sandhopper::conceal::hopper
