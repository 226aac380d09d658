#include "tools/plant/world.hpp"

#include <algorithm>
#include <stdexcept>

#include "tools/plant/trial_draw.hpp"

namespace sandhopper {

World::World(const WorldConfig& config, const TrialSetup& setup, std::int64_t start_ns)
    : World(config, setup,
            TrialDraw(config, {.seed = setup.seed,
                               .noise = setup.noise,
                               .start_ns = start_ns,
                               .robot_seed = setup.robot_seed}),
            start_ns) {}

World::World(const WorldConfig& config, const TrialSetup& setup, const TrialDraw& draw, std::int64_t start_ns)
    : gravity_mps2_(config.gravity_mps2),
      release_speed_mps_(draw.release().speed_mps),
      surface_height_m_(draw.release().surface_height_m),
      motors_(static_cast<std::size_t>(config.robot.leg.motor_count)),
      joint_friction_Nm_(config.robot.leg.motor_count * config.robot.joint_coulomb_Nm),
      start_ns_(start_ns),
      now_ns_(start_ns),
      plant_(config, draw.bed(), {.cable_force_N = draw.cable_force_N(), .bed_memory = setup.bed_memory}),
      drive_{draw.drive(Side::left), draw.drive(Side::right)},
      imu_body_(draw.imu_body()),
      imu_foot_(draw.imu_foot()),
      tof_(draw.tof()),
      load_cell_(draw.load_cell()),
      mocap_(draw.mocap()) {
  const double foot_z_m = setup.release_height_m + draw.release().height_m - surface_height_m_;
  if (!(foot_z_m >= 0.0))
    throw std::invalid_argument("trial: release_height_m puts the foot below the surface; raise it");
  const double angle_rad = plant_.leg().angle_at_length(config.controller.compression_length_m);
  plant_.place({.foot_z_m = foot_z_m, .angle_rad = angle_rad});
  for (auto& drive : drive_) drive.place(angle_rad);
  imu_body_.reset(gravity_mps2_);
  imu_foot_.reset(gravity_mps2_);
  take_truth();
  tof_.reset(truth_.body_z_m);
  mocap_.reset({truth_.body_z_m + surface_height_m_, truth_.foot_z_m + surface_height_m_});
}

void World::open_catch() noexcept {
  if (truth_.released) return;
  truth_.released = true;
  fixture_ = {};
  PlantState state = plant_.state();
  state.foot_velocity_mps = release_speed_mps_;
  plant_.place(state);
}

void World::hold(const Fixture& fixture) noexcept {
  if (truth_.released) return;
  fixture_ = fixture;
  fixture_ns_ = now_ns_;
  PlantState state = plant_.state();
  if (fixture.leg_angle_rad) state.angle_rad = *fixture.leg_angle_rad;
  held_angle_rad_ = state.angle_rad;
  plant_.place(state);
  if (fixture.body_height_m) {
    state.foot_z_m += *fixture.body_height_m - plant_.motion(0.0).body_z_m;
    plant_.place(state);
  }
}

void World::command(Side side, const MotorCommand& command, bool enabled) noexcept {
  drive_[static_cast<std::size_t>(side)].command(command, enabled);
}

MotorSample World::read_motor(Side side) const noexcept {
  return drive_[static_cast<std::size_t>(side)].sample(now_ns_);
}

double World::motor_torque_Nm() const noexcept {
  double sum = 0.0;
  for (std::size_t i = 0; i < motors_; ++i) sum += drive_[i].torque_Nm();
  return sum;
}

void World::advance_to(std::int64_t time_ns) noexcept {
  while (now_ns_ + kStep_ns <= time_ns) step();
}

void World::step() noexcept {
  for (auto& drive : drive_) drive.step();
  if (truth_.released)
    plant_.step(motor_torque_Nm());
  else if (fixture_.leg_swing_rad > 0.0)
    swing_leg();
  const GridStep step{.from_ns = now_ns_, .to_ns = now_ns_ + kStep_ns};
  now_ns_ = step.to_ns;
  for (auto& drive : drive_) drive.measure(plant_.state().rotor_rad());
  take_truth();

  const bool released = truth_.released;
  const bool stance = released && truth_.contact_force_N > 0.0;
  const auto& body_up = fixture_.body_up;
  const auto& foot_up = fixture_.foot_up;
  imu_body_.step(step, {truth_.body_accel_mps2 + gravity_mps2_ * body_up[2],
                        stance,
                        released,
                        {gravity_mps2_ * body_up[0], gravity_mps2_ * body_up[1]}});
  imu_foot_.step(step, {truth_.foot_accel_mps2 + gravity_mps2_ * foot_up[2],
                        stance,
                        released,
                        {gravity_mps2_ * foot_up[0], gravity_mps2_ * foot_up[1]}});
  tof_.step(step, truth_.body_z_m);
  load_cell_.step(step, truth_.contact_force_N);
  mocap_.step(step, {truth_.body_z_m + surface_height_m_, truth_.foot_z_m + surface_height_m_});
  truth_.mocap_time_ns = mocap_.frame().time_ns;
  truth_.mocap_body_z_m = mocap_.frame().body_z_m;
  truth_.mocap_foot_z_m = mocap_.frame().foot_z_m;
}

void World::swing_leg() noexcept {
  PlantState state = plant_.state();
  const double since_s = static_cast<double>(now_ns_ + kStep_ns - fixture_ns_) * 1e-9;
  state.angle_rad = held_angle_rad_ + fixture_.swing_at(since_s);
  plant_.place(state);
}

void World::take_truth() noexcept {
  const auto& state = plant_.state();
  const PlantMotion motion = plant_.motion(motor_torque_Nm());
  const bool released = truth_.released;
  truth_.time_ns = now_ns_;
  truth_.body_z_m = motion.body_z_m;
  truth_.body_velocity_mps = motion.body_velocity_mps;
  truth_.body_accel_mps2 = released ? motion.body_accel_mps2 : 0.0;
  truth_.foot_z_m = state.foot_z_m;
  truth_.foot_velocity_mps = state.foot_velocity_mps;
  truth_.foot_accel_mps2 = released ? motion.foot_accel_mps2 : 0.0;
  truth_.leg_angle_rad = state.angle_rad;
  truth_.leg_velocity_radps = state.angular_velocity_radps;
  truth_.leg_length_m = motion.leg_length_m;
  truth_.motor_torque_Nm = motor_torque_Nm();
  truth_.contact_force_N = released ? motion.contact_force_N : 0.0;
  if (!released) take_held_truth();
  truth_.contact_impulse_Ns = plant_.contact_impulse_Ns();
  truth_.max_depth_m = plant_.max_depth_m();
}

// Forces and accelerations that the fixture causes on a robot that is held.
void World::take_held_truth() noexcept {
  const double tap = fixture_.tap_at(static_cast<double>(now_ns_ - fixture_ns_) * 1e-9);
  truth_.body_accel_mps2 = truth_.foot_accel_mps2 = fixture_.tap_accel_mps2 * tap;
  truth_.contact_force_N = fixture_.load_N + fixture_.tap_force_N * tap;
  if (!fixture_.clamped) return;
  const double torque_Nm = pressed_.follow(motor_torque_Nm(), joint_friction_Nm_);
  const double length_gain = plant_.leg().kinematics(plant_.state().angle_rad).dlength_m_per_rad;
  truth_.contact_force_N += std::max(0.0, torque_Nm / length_gain);
}

std::int64_t World::next_sample_ns() const noexcept {
  const std::int64_t earliest_ns = std::min({imu_body_.next_sample_ns(), imu_foot_.next_sample_ns(),
                                             tof_.next_sample_ns(), load_cell_.next_sample_ns()});
  const std::int64_t since_start_ns = earliest_ns - start_ns_;
  return start_ns_ + (since_start_ns + kStep_ns - 1) / kStep_ns * kStep_ns;
}

}  // namespace sandhopper
