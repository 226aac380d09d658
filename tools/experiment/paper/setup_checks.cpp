#include "tools/experiment/paper/setup_checks.hpp"

#include <cmath>
#include <vector>

#include "tools/experiment/nominal_stride.hpp"
#include "tools/experiment/paper/hop_trial.hpp"
#include "tools/experiment/statistics.hpp"

namespace sandhopper::paper {

double drop_speed_mps(const WorldConfig& config, double height_m, bool friction) {
  WorldConfig world = config;
  if (!friction)
    world.robot.rail_coulomb_N = world.robot.joint_coulomb_Nm = world.robot.cogging_amplitude_Nm = 0.0;
  const auto stride = nominal_stride({.release_height_m = height_m}, world);
  for (const auto& truth : stride.grid)
    if (truth.foot_z_m <= 0.0) return -truth.foot_velocity_mps;
  return std::nan("");
}

LegStiffness leg_stiffness(const CycleConfig& cycle, const WorldConfig& world,
                           double compression_stiffness_N_per_m) {
  const HopCell cell{1.0, 0.0618, compression_stiffness_N_per_m};
  const auto trial = run_hop(cycle, world, cell, {.noise = false});
  const Leg leg(world.robot.leg);
  constexpr double kUnsaturated = 0.95;
  constexpr std::size_t kSettled_rows = 10;  // rows after a change of law
  const double limit_Nm = kUnsaturated * world.robot.leg.motor_count * world.motor.torque_limit_Nm;
  const auto stiffness = [&](std::size_t from, std::size_t to) {
    std::vector<double> length_m, force_N;
    for (std::size_t i = from + kSettled_rows; i < to; ++i) {
      // The torque responds to the state that the cycle saw one row before.
      const auto& seen = trial.rows[i - 1].truth;
      const double torque_Nm = trial.rows[i].truth.motor_torque_Nm;
      if (std::abs(torque_Nm) > limit_Nm) continue;
      length_m.push_back(seen.leg_length_m);
      force_N.push_back(torque_Nm / leg.kinematics(seen.leg_angle_rad).dlength_m_per_rad);
    }
    return length_m.size() < 3 ? std::nan("") : -fit_line(length_m, force_N).slope;
  };
  const auto at = stance_rows(trial);
  return {stiffness(at.contact, at.change), stiffness(at.change, at.liftoff)};
}

}  // namespace sandhopper::paper
