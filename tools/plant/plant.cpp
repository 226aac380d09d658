#include "tools/plant/plant.hpp"

#include <algorithm>
#include <cmath>

namespace sandhopper {
namespace {

constexpr double kRailSwitchSpeed_mps = 0.01;
constexpr double kJointSwitchSpeed_radps = 0.2;
constexpr double kEndStopStiffness_Nm_per_rad = 200.0;
constexpr double kNever_s = 1e9;

}  // namespace

Plant::Plant(const WorldConfig& config, const Bed& bed, const Options& options)
    : robot_(config.robot),
      gravity_mps2_(config.gravity_mps2),
      leg_(config.robot.leg),
      bed_(bed),
      options_(options),
      motors_(config.robot.leg.motor_count),
      rigid_(config.terrain.rigid) {}

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
    friction =
        -motors_ * robot_.joint_coulomb_Nm * std::tanh(s.angular_velocity_radps / kJointSwitchSpeed_radps);
  if (robot_.cogging_amplitude_Nm != 0.0)
    cogging = motors_ * robot_.cogging_amplitude_Nm * std::sin(robot_.cogging_periods_per_rev * s.angle_rad);
  const double stops = kEndStopStiffness_Nm_per_rad * (std::max(0.0, kEndStopLow_rad - s.angle_rad) -
                                                       std::max(0.0, s.angle_rad - kEndStopHigh_rad));
  return friction + cogging + stops;
}

Plant::Rates Plant::rates(const PlantState& s, double torque_Nm) const noexcept {
  Rates r{};
  r.dynamics =
      options_.leg_table != nullptr ? options_.leg_table->dynamics(s.angle_rad) : leg_.dynamics(s.angle_rad);
  const auto& d = r.dynamics;
  const double spin2 = s.angular_velocity_radps * s.angular_velocity_radps;
  const double body_velocity = s.foot_velocity_mps + d.leg.dlength_m_per_rad * s.angular_velocity_radps;
  r.rail_force_N = -robot_.rail_viscous_N_s_per_m * body_velocity - options_.cable_force_N;
  if (robot_.rail_coulomb_N != 0.0)
    r.rail_force_N -= robot_.rail_coulomb_N * std::tanh(body_velocity / kRailSwitchSpeed_mps);
  r.joint_torque_Nm = joint_torque_Nm(s);
  if (options_.extension != nullptr) {
    const double body_z = s.foot_z_m + leg_.parameters().foot_height_m + d.leg.length_m;
    r.rail_force_N +=
        options_.extension->rail_force_N(body_z, body_velocity, torque_Nm / d.leg.dlength_m_per_rad);
    r.joint_torque_Nm += options_.extension->joint_torque_Nm(s, torque_Nm);
  }
  const double torque = torque_Nm + r.rail_force_N * d.leg.dlength_m_per_rad + r.joint_torque_Nm;
  const double free_force = r.rail_force_N - d.torque_gain_per_m * torque - d.coriolis_N_s2_per_rad2 * spin2 -
                            d.reduced_mass_kg * gravity_mps2_;
  if (standing_) {
    r.contact_force_N = -free_force;
  } else if (rigid_) {
    r.foot_accel_mps2 = free_force / d.reduced_mass_kg;
  } else {
    const auto ground = bed_.reaction({.depth_m = std::max(0.0, -s.foot_z_m),
                                       .speed_mps = -s.foot_velocity_mps,
                                       .max_depth_m = max_depth_m_,
                                       .damping_mass_kg = d.reduced_mass_kg});
    const double with_cone = (free_force + ground.force_N) / (d.reduced_mass_kg + ground.added_mass_kg);
    r.contact_force_N = ground.at_acceleration(with_cone);
    r.foot_accel_mps2 = (free_force + r.contact_force_N) / d.reduced_mass_kg;
  }
  r.angular_accel_radps2 =
      (torque - d.m12_kg_m * (r.foot_accel_mps2 + gravity_mps2_) - 0.5 * d.dm22_kg_m2_per_rad * spin2) /
      d.m22_kg_m2;
  return r;
}

void Plant::step(double torque_Nm, double step_s) noexcept {
  const double h = step_s;
  const PlantState s0 = state_;
  const auto moved = [&s0](const PlantState& at, const Rates& rate, double dt) {
    return PlantState{.foot_z_m = s0.foot_z_m + dt * at.foot_velocity_mps,
                      .foot_velocity_mps = s0.foot_velocity_mps + dt * rate.foot_accel_mps2,
                      .angle_rad = s0.angle_rad + dt * at.angular_velocity_radps,
                      .angular_velocity_radps = s0.angular_velocity_radps + dt * rate.angular_accel_radps2};
  };
  const auto weighted = [](double a, double b, double c, double d) { return (a + 2.0 * (b + c) + d) / 6.0; };

  const Rates k1 = rates(s0, torque_Nm);
  const PlantState s1 = moved(s0, k1, h / 2);
  const Rates k2 = rates(s1, torque_Nm);
  const PlantState s2 = moved(s1, k2, h / 2);
  const Rates k3 = rates(s2, torque_Nm);
  const PlantState s3 = moved(s2, k3, h);
  const Rates k4 = rates(s3, torque_Nm);

  state_.foot_z_m +=
      h * weighted(s0.foot_velocity_mps, s1.foot_velocity_mps, s2.foot_velocity_mps, s3.foot_velocity_mps);
  state_.foot_velocity_mps +=
      h * weighted(k1.foot_accel_mps2, k2.foot_accel_mps2, k3.foot_accel_mps2, k4.foot_accel_mps2);
  state_.angle_rad += h * weighted(s0.angular_velocity_radps, s1.angular_velocity_radps,
                                   s2.angular_velocity_radps, s3.angular_velocity_radps);
  state_.angular_velocity_radps += h * weighted(k1.angular_accel_radps2, k2.angular_accel_radps2,
                                                k3.angular_accel_radps2, k4.angular_accel_radps2);
  contact_impulse_Ns_ +=
      h * weighted(k1.contact_force_N, k2.contact_force_N, k3.contact_force_N, k4.contact_force_N);

  finish_step(torque_Nm);
}

// How long until the force has a kink or a jump, if the acceleration stays: the sole meets the surface, comes
// to rest in the bed (which yields no further) or is back where it was deepest (where it yields again).
double Plant::next_event_s(double accel_mps2) const noexcept {
  const double z = state_.foot_z_m, v = state_.foot_velocity_mps;
  const double level_m = z > 0.0 ? 0.0 : -max_depth_m_;
  if (z <= level_m) return v < 0.0 && accel_mps2 > 0.0 ? -v / accel_mps2 : kNever_s;
  const double root = v * v - 2.0 * accel_mps2 * (z - level_m);
  if (root <= 0.0) return kNever_s;
  const double event_s = 2.0 * (z - level_m) / (std::sqrt(root) - v);
  return event_s > 0.0 ? event_s : kNever_s;
}

PlantMotion Plant::advance(double torque_Nm, double step_s) noexcept {
  constexpr int kMostPieces = 6;
  constexpr double kLeastPiece_s = 1e-8;
  Rates now = rates(state_, torque_Nm);
  const PlantMotion motion = motion_of(now);
  double left_s = step_s;
  for (int piece = 1;; ++piece) {
    const bool stiff = state_.foot_z_m <= 0.0 && state_.foot_z_m > -max_depth_m_;
    double piece_s = stiff ? std::min(left_s, 0.5 * step_s) : left_s;
    if (!rigid_) piece_s = std::min(piece_s, std::max(kLeastPiece_s, next_event_s(now.foot_accel_mps2)));
    if (piece == kMostPieces || left_s - piece_s < kLeastPiece_s) piece_s = left_s;
    midpoint(now, torque_Nm, piece_s);
    left_s -= piece_s;
    if (left_s <= 0.0) return motion;
    now = rates(state_, torque_Nm);
  }
}

void Plant::midpoint(const Rates& k1, double torque_Nm, double step_s) noexcept {
  const PlantState s0 = state_;
  const double half = 0.5 * step_s;
  const PlantState middle{
      .foot_z_m = s0.foot_z_m + half * s0.foot_velocity_mps,
      .foot_velocity_mps = s0.foot_velocity_mps + half * k1.foot_accel_mps2,
      .angle_rad = s0.angle_rad + half * s0.angular_velocity_radps,
      .angular_velocity_radps = s0.angular_velocity_radps + half * k1.angular_accel_radps2};
  const Rates k2 = rates(middle, torque_Nm);
  state_.foot_z_m += step_s * middle.foot_velocity_mps;
  state_.foot_velocity_mps += step_s * k2.foot_accel_mps2;
  state_.angle_rad += step_s * middle.angular_velocity_radps;
  state_.angular_velocity_radps += step_s * k2.angular_accel_radps2;
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

// Impact: an impulse at the foot leaves the momentum of phi alone, M12 dv_f + M22 dphid = 0, and takes M_f
// v_f.
void Plant::settle_on_rigid_ground(double torque_Nm) noexcept {
  if (standing_) {
    standing_ = rates(state_, torque_Nm).contact_force_N > 0.0;
  } else if (state_.foot_z_m <= 0.0 && state_.foot_velocity_mps < 0.0) {
    const auto d = leg_.dynamics(state_.angle_rad);
    state_.angular_velocity_radps += d.torque_gain_per_m * state_.foot_velocity_mps;
    contact_impulse_Ns_ -= d.reduced_mass_kg * state_.foot_velocity_mps;
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
          .body_z_m = state_.foot_z_m + leg_.parameters().foot_height_m + leg.length_m,
          .body_velocity_mps = state_.foot_velocity_mps + leg.dlength_m_per_rad * spin,
          .body_accel_mps2 = r.foot_accel_mps2 + leg.dlength_m_per_rad * r.angular_accel_radps2 +
                             leg.d2length_m_per_rad2 * spin * spin,
          .leg_length_m = leg.length_m,
          .contact_force_N = r.contact_force_N,
          .rail_force_N = r.rail_force_N,
          .joint_torque_Nm = r.joint_torque_Nm};
}

}  // namespace sandhopper
