#include "tools/plant/plant.hpp"

#include <algorithm>
#include <cmath>

namespace sandhopper {
namespace {

constexpr double kEndStopStiffness_Nm_per_rad = 200.0;
constexpr double kNever_s = 1e9;
constexpr double kTeethDampingRatio = 0.5;
constexpr double kCalm_mps2 = 0.5;          // a foot that oscillates on the unloading line accelerates more
constexpr double kPhasePerPiece_rad = 0.5;  // largest phase of the fastest oscillation in one midpoint step
constexpr double kLeastFoot_kg = 1e-3;      // a spring needs a mass to act on

}  // namespace

Plant::Plant(const WorldConfig& config, const Bed& bed, const Options& options)
    : robot_(config.robot),
      gravity_mps2_(config.gravity_mps2),
      leg_(config.robot.leg),
      bed_(bed),
      options_(options),
      motors_(config.robot.leg.motor_count),
      rigid_(config.terrain.rigid) {
  const auto& leg = config.robot.leg;
  if (robot_.series_compliance_m_per_N > 0.0 && leg.foot_mass_kg > kLeastFoot_kg) {
    series_N_per_m_ = 1.0 / robot_.series_compliance_m_per_N;
    series_N_s_per_m_ = 2.0 * robot_.series_damping_ratio * std::sqrt(series_N_per_m_ * leg.foot_mass_kg);
  }
  rotors_kg_m2_ = motors_ * leg.rotor_inertia_kg_m2 * leg.gear_ratio * leg.gear_ratio;
  if (robot_.joint_play_rad > 0.0 && rotors_kg_m2_ > 0.0) {
    teeth_Nm_per_rad_ = 1.0 / (robot_.joint_give_relative * robot_.joint_play_rad);
    teeth_Nm_s_ = 2.0 * kTeethDampingRatio * std::sqrt(teeth_Nm_per_rad_ * rotors_kg_m2_);
  }
}

void Plant::place(const PlantState& state) noexcept {
  state_ = state;
  max_depth_m_ = std::max(0.0, -state.foot_z_m);
  contact_impulse_Ns_ = 0.0;
  standing_ = false;
}

void Plant::place_in_crater(const PlantState& state, double max_depth_m) noexcept {
  place(state);
  max_depth_m_ = std::max(max_depth_m_, max_depth_m);
}

double Plant::joint_torque_Nm(const PlantState& s) const noexcept {
  double friction = 0.0, cogging = 0.0;
  if (robot_.joint_coulomb_Nm != 0.0)
    friction = -motors_ * robot_.joint_coulomb_Nm *
               std::tanh(s.angular_velocity_radps /
                         (options_.friction_switch_factor * robot_.joint_friction_switch_speed_radps));
  if (robot_.cogging_amplitude_Nm != 0.0)
    cogging = motors_ * robot_.cogging_amplitude_Nm * std::sin(robot_.cogging_periods_per_rev * s.angle_rad);
  const double stops = kEndStopStiffness_Nm_per_rad * (std::max(0.0, kEndStopLow_rad - s.angle_rad) -
                                                       std::max(0.0, s.angle_rad - kEndStopHigh_rad));
  return friction + cogging + stops;
}

// Torque that the gear teeth transmit from rotors to links.
double Plant::transmitted_Nm(const PlantState& s) const noexcept {
  const double half = 0.5 * robot_.joint_play_rad;
  const double pressed = s.play_rad - std::clamp(s.play_rad, -half, half);
  return pressed == 0.0 ? 0.0 : teeth_Nm_per_rad_ * pressed + teeth_Nm_s_ * s.play_radps;
}

// Removes the rotors' inertia, which is constant, from the leg's dynamics.
void Plant::free_rotors(LegDynamics& d) const noexcept {
  d.m22_kg_m2 -= rotors_kg_m2_;
  const double gain = d.m12_kg_m / d.m22_kg_m2;
  d.reduced_mass_kg = d.m11_kg - gain * d.m12_kg_m;
  d.coriolis_N_s2_per_rad2 += 0.5 * (d.torque_gain_per_m - gain) * d.dm22_kg_m2_per_rad;
  d.torque_gain_per_m = gain;
}

Plant::Rates Plant::rates(const PlantState& s, double motors_Nm) const noexcept {
  Rates r{};
  r.dynamics =
      options_.leg_table != nullptr ? options_.leg_table->dynamics(s.angle_rad) : leg_.dynamics(s.angle_rad);
  auto& d = r.dynamics;
  double torque_Nm = motors_Nm;
  if (teeth_Nm_per_rad_ > 0.0) {
    free_rotors(d);
    torque_Nm = transmitted_Nm(s);
    r.play_accel_radps2 = (motors_Nm - torque_Nm) / rotors_kg_m2_;
  }
  const double spin2 = s.angular_velocity_radps * s.angular_velocity_radps;
  const double toe_velocity = s.foot_velocity_mps - s.series_mps;
  const double body_velocity = toe_velocity + d.leg.dlength_m_per_rad * s.angular_velocity_radps;
  r.rail_force_N = -robot_.rail_viscous_N_s_per_m * body_velocity - options_.cable_force_N;
  if (robot_.rail_coulomb_N != 0.0)
    r.rail_force_N -=
        robot_.rail_coulomb_N *
        std::tanh(body_velocity / (options_.friction_switch_factor * robot_.rail_friction_switch_speed_mps));
  r.joint_torque_Nm = joint_torque_Nm(s);
  if (options_.extension != nullptr) {
    const double body_z = s.foot_z_m - s.series_m + leg_.parameters().foot_height_m + d.leg.length_m;
    r.rail_force_N +=
        options_.extension->rail_force_N(body_z, body_velocity, torque_Nm / d.leg.dlength_m_per_rad);
    r.joint_torque_Nm += options_.extension->joint_torque_Nm(s, torque_Nm);
  }
  const double torque = torque_Nm + r.rail_force_N * d.leg.dlength_m_per_rad + r.joint_torque_Nm;
  double free_force = r.rail_force_N - d.torque_gain_per_m * torque - d.coriolis_N_s2_per_rad2 * spin2 -
                      d.reduced_mass_kg * gravity_mps2_;
  double mass_kg = d.reduced_mass_kg, toe_accel_mps2 = 0.0;
  if (series_N_per_m_ > 0.0) {
    const double foot_kg = leg_.parameters().foot_mass_kg;
    const double spring_N = series_N_per_m_ * s.series_m + series_N_s_per_m_ * s.series_mps;
    toe_accel_mps2 = (free_force + foot_kg * gravity_mps2_ + spring_N) / (mass_kg - foot_kg);
    free_force = -spring_N - foot_kg * gravity_mps2_;
    mass_kg = foot_kg;
  }
  if (standing_) {
    r.contact_force_N = -free_force;
  } else if (rigid_) {
    r.foot_accel_mps2 = free_force / mass_kg;
  } else {
    const auto ground = bed_.reaction({.depth_m = std::max(0.0, -s.foot_z_m),
                                       .speed_mps = -s.foot_velocity_mps,
                                       .max_depth_m = max_depth_m_,
                                       .damping_mass_kg = d.reduced_mass_kg,
                                       .deepest_N = deepest_N()});
    const double with_cone = (free_force + ground.force_N) / (mass_kg + ground.added_mass_kg);
    r.contact_force_N = ground.at_acceleration(with_cone);
    r.foot_accel_mps2 = (free_force + r.contact_force_N) / mass_kg;
  }
  if (series_N_per_m_ > 0.0)
    r.series_accel_mps2 = r.foot_accel_mps2 - toe_accel_mps2;
  else
    toe_accel_mps2 = r.foot_accel_mps2;
  r.angular_accel_radps2 =
      (torque - d.m12_kg_m * (toe_accel_mps2 + gravity_mps2_) - 0.5 * d.dm22_kg_m2_per_rad * spin2) /
      d.m22_kg_m2;
  if (teeth_Nm_per_rad_ > 0.0) r.play_accel_radps2 -= r.angular_accel_radps2;
  return r;
}

double Plant::deepest_N() const noexcept {
  if (state_.foot_z_m >= 0.0 || -state_.foot_z_m >= max_depth_m_) return -1.0;
  if (known_depth_m_ != max_depth_m_) {
    known_depth_m_ = max_depth_m_;
    known_N_ = bed_.curve_N(max_depth_m_);
  }
  return known_N_;
}

// State `from` after `dt_s`, with the speeds of `at` and these accelerations.
PlantState Plant::moved(const PlantState& from, const PlantState& at, const Rates& r, double dt_s) noexcept {
  return {.foot_z_m = from.foot_z_m + dt_s * at.foot_velocity_mps,
          .foot_velocity_mps = from.foot_velocity_mps + dt_s * r.foot_accel_mps2,
          .angle_rad = from.angle_rad + dt_s * at.angular_velocity_radps,
          .angular_velocity_radps = from.angular_velocity_radps + dt_s * r.angular_accel_radps2,
          .series_m = from.series_m + dt_s * at.series_mps,
          .series_mps = from.series_mps + dt_s * r.series_accel_mps2,
          .play_rad = from.play_rad + dt_s * at.play_radps,
          .play_radps = from.play_radps + dt_s * r.play_accel_radps2};
}

void Plant::step(double torque_Nm, double step_s) noexcept {
  const double h = step_s;
  const PlantState s0 = state_;
  const Rates k1 = rates(s0, torque_Nm);
  const PlantState s1 = moved(s0, s0, k1, h / 2);
  const Rates k2 = rates(s1, torque_Nm);
  const PlantState s2 = moved(s0, s1, k2, h / 2);
  const Rates k3 = rates(s2, torque_Nm);
  const PlantState s3 = moved(s0, s2, k3, h);
  const Rates k4 = rates(s3, torque_Nm);

  PlantState next = moved(s0, s0, k1, h / 6);
  next = moved(next, s1, k2, h / 3);
  next = moved(next, s2, k3, h / 3);
  state_ = moved(next, s3, k4, h / 6);
  contact_impulse_Ns_ +=
      h / 6 * (k1.contact_force_N + 2.0 * (k2.contact_force_N + k3.contact_force_N) + k4.contact_force_N);

  finish_step(torque_Nm);
}

// Time until the force has a kink or a jump if the acceleration stays constant: the sole meets the surface,
// comes to rest in the bed (penetration ends) or returns to its deepest point (penetration starts again).
double Plant::next_event_s(double accel_mps2) const noexcept {
  const double z = state_.foot_z_m, v = state_.foot_velocity_mps;
  const double level_m = z > 0.0 ? 0.0 : -max_depth_m_;
  if (z <= level_m) return v < 0.0 && accel_mps2 > 0.0 ? -v / accel_mps2 : kNever_s;
  const double root = v * v - 2.0 * accel_mps2 * (z - level_m);
  if (root <= 0.0) return kNever_s;
  const double event_s = 2.0 * (z - level_m) / (std::sqrt(root) - v);
  return event_s > 0.0 ? event_s : kNever_s;
}

// Largest step for the plant's own springs, which oscillate faster than a step.
double Plant::longest_piece_s(const LegDynamics& d, double step_s) const noexcept {
  double quickest = 0.0;  // rad^2/s^2
  if (series_N_per_m_ > 0.0) {
    const double foot_kg = leg_.parameters().foot_mass_kg;
    const double leg_kg = d.reduced_mass_kg - foot_kg;
    quickest = series_N_per_m_ * (1.0 / foot_kg + 1.0 / leg_kg);
  }
  if (teeth_Nm_per_rad_ > 0.0)
    quickest = std::max(quickest, teeth_Nm_per_rad_ * (1.0 / rotors_kg_m2_ + 1.0 / d.m22_kg_m2));
  return quickest > 0.0 ? std::min(step_s, kPhasePerPiece_rad / std::sqrt(quickest)) : step_s;
}

PlantMotion Plant::advance(double torque_Nm, double step_s) noexcept {
  constexpr int kMostEvents = 6;
  constexpr double kLeastPiece_s = 1e-8;
  Rates now = rates(state_, torque_Nm);
  const double longest_s = longest_piece_s(now.dynamics, step_s);
  const int most_pieces = kMostEvents + static_cast<int>(step_s / longest_s) - 1;
  const PlantMotion motion = motion_of(now);
  double left_s = step_s;
  for (int piece = 1;; ++piece) {
    const bool swings = state_.foot_z_m <= 0.0 && state_.foot_z_m > -max_depth_m_ &&
                        std::abs(now.foot_accel_mps2) > kCalm_mps2;
    double piece_s = std::min({left_s, longest_s, swings ? 0.5 * step_s : step_s});
    if (!rigid_) piece_s = std::min(piece_s, std::max(kLeastPiece_s, next_event_s(now.foot_accel_mps2)));
    if (piece == most_pieces || left_s - piece_s < kLeastPiece_s) piece_s = left_s;
    midpoint(now, torque_Nm, piece_s);
    left_s -= piece_s;
    if (left_s <= 0.0) return motion;
    now = rates(state_, torque_Nm);
  }
}

void Plant::midpoint(const Rates& k1, double torque_Nm, double step_s) noexcept {
  const PlantState s0 = state_;
  const PlantState middle = moved(s0, s0, k1, 0.5 * step_s);
  const Rates k2 = rates(middle, torque_Nm);
  state_ = moved(s0, middle, k2, step_s);
  contact_impulse_Ns_ += step_s * k2.contact_force_N;
  finish_step(torque_Nm);
}

void Plant::finish_step(double torque_Nm) noexcept {
  if (rigid_) {
    settle_on_rigid_ground(torque_Nm);
  } else if (!options_.bed_memory && state_.foot_z_m > 0.0) {
    max_depth_m_ = 0.0;
  } else {
    max_depth_m_ = std::max(max_depth_m_, -state_.foot_z_m);
  }
}

// Plastic impact: the impulse at the foot keeps the momentum of phi, M12 dv_f + M22 dphid = 0, and removes
// M_f v_f.
void Plant::settle_on_rigid_ground(double torque_Nm) noexcept {
  if (standing_) {
    standing_ = rates(state_, torque_Nm).contact_force_N > 0.0;
  } else if (state_.foot_z_m <= 0.0 && state_.foot_velocity_mps < 0.0) {
    if (series_N_per_m_ > 0.0) {  // the spring isolates the leg from the impact
      state_.series_mps -= state_.foot_velocity_mps;
      contact_impulse_Ns_ -= leg_.parameters().foot_mass_kg * state_.foot_velocity_mps;
    } else {
      auto d = leg_.dynamics(state_.angle_rad);
      if (teeth_Nm_per_rad_ > 0.0) {  // the impact changes the links' speed but not the rotors'
        free_rotors(d);
        state_.play_radps -= d.torque_gain_per_m * state_.foot_velocity_mps;
      }
      state_.angular_velocity_radps += d.torque_gain_per_m * state_.foot_velocity_mps;
      contact_impulse_Ns_ -= d.reduced_mass_kg * state_.foot_velocity_mps;
    }
    state_.foot_velocity_mps = 0.0;
    state_.foot_z_m = 0.0;
    standing_ = true;
  }
}

PlantMotion Plant::motion(double torque_Nm) const noexcept { return motion_of(rates(state_, torque_Nm)); }

PlantMotion Plant::motion_of(const Rates& r) const noexcept {
  const auto& leg = r.dynamics.leg;
  const double spin = state_.angular_velocity_radps;
  return {.foot_accel_mps2 = r.foot_accel_mps2,
          .angular_accel_radps2 = r.angular_accel_radps2,
          .body_z_m = state_.foot_z_m - state_.series_m + leg_.parameters().foot_height_m + leg.length_m,
          .body_velocity_mps = state_.foot_velocity_mps - state_.series_mps + leg.dlength_m_per_rad * spin,
          .body_accel_mps2 = r.foot_accel_mps2 - r.series_accel_mps2 +
                             leg.dlength_m_per_rad * r.angular_accel_radps2 +
                             leg.d2length_m_per_rad2 * spin * spin,
          .leg_length_m = leg.length_m,
          .contact_force_N = r.contact_force_N,
          .rail_force_N = r.rail_force_N,
          .joint_torque_Nm = r.joint_torque_Nm};
}

}  // namespace sandhopper
