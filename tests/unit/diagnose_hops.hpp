#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

#include "estimation/leg.hpp"
#include "tools/diagnose/fit/fit.hpp"
#include "tools/diagnose/fit/linearise.hpp"
#include "tools/diagnose/fit/prepare.hpp"
#include "tools/diagnose/model/trial.hpp"
#include "tools/diagnose/plants/hopper/hopper_belief.hpp"
#include "tools/diagnose/plants/hopper/hopper_simulation.hpp"
#include "tools/plant/random.hpp"

// Hops in memory for the tests of the diagnosis.
namespace sandhopper::diagnose {

// A hop released at `release_m`, lasting `to_s`, with `edits` of the world.
inline HopperRun hop_from(double release_m, double to_s, const Edits& edits = {}) {
  HopperRun run;
  run.world = world_of(Belief{}, edits);
  run.start.foot_z_m = release_m;
  run.start.angle_rad = Leg(run.world.robot.leg).angle_at_length(run.world.controller.compression_length_m);
  run.to_s = to_s;
  return run;
}

// A run as accelerometers, encoders, drives, load cell and height sensor record it at 1 kHz, with the
// commands, and with the phases if they are imposed. `seed` 0: no noise.
inline Trial recorded(const HopperRun& run, const Edits& edits = {}, std::uint64_t seed = 0) {
  const auto traces = simulate_hopper(run, edits);
  const auto& robot = run.world.robot;
  Random random(seed, 0), of_velocity(seed, 1);
  Trial trial;
  trial.kind = "hop";
  trial.setup["release_height_m"] = run.start.foot_z_m;
  const auto put_with = [&](Random& noise, const std::string& channel, double value, double sd) {
    trial.channels[channel].push_back(value + (seed == 0 ? 0.0 : sd * noise.normal()));
  };
  const auto put = [&](const std::string& channel, double value, double sd) {
    put_with(random, channel, value, sd);
  };
  const auto samples = static_cast<std::size_t>(1e3 * run.to_s + 0.5);
  for (std::size_t i = 0; i < samples; ++i) {
    const double t = 1e-3 * static_cast<double>(i), g = run.world.gravity_mps2;
    trial.time_s.push_back(t);
    if (run.phases != nullptr)
      trial.channels["phase"].push_back(static_cast<double>(phase_at(*run.phases, t)));
    put("imu_body_accel_z_mps2", traces.body_accel_mps2.at(t) + g, 0.05);
    put("imu_foot_accel_z_mps2", traces.foot_accel_mps2.at(t) + g, 0.05);
    for (const std::string side : {"left", "right"}) {
      const std::string motor = "motor_" + side;
      put(motor + "_position_rad", traces.angle_rad.at(t), 2e-4);
      put(motor + "_current_A",
          traces.current_torque_Nm.at(t) / robot.leg.motor_count / run.world.motor.torque_constant_Nm_per_A,
          0.05);
      put_with(of_velocity, motor + "_velocity_radps", traces.rate_radps.at(t), 0.1);
      trial.channels[motor + "_temperature_C"].push_back(40.0 + 300.0 * run.start.foot_z_m);
      trial.channels["command_" + side + "_torque_Nm"].push_back(traces.command_torque_Nm.at(t) /
                                                                 robot.leg.motor_count);
    }
    put("load_cell_force_N", traces.force_N.at(t), 0.1);
    put("tof_height_m", traces.body_z_m.at(t), 2e-3);
  }
  return trial;
}

// The fit with nothing missing, its noise estimated and its derivatives kept.
inline Point settled_null(Problem& problem) {
  Point point = fit_from(problem, null_point(problem), {.max_iterations = 6}).point;
  update_noise(problem, point);
  keep_columns(problem, point);
  point = fit_from(problem, point).point;
  keep_columns(problem, point);
  return point;
}

}  // namespace sandhopper::diagnose
