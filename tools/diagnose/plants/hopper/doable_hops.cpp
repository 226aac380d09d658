#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/diagnose/plants/doable.hpp"
#include "tools/diagnose/plants/hopper/hopper_belief.hpp"
#include "tools/diagnose/plants/hopper/hopper_recording.hpp"
#include "tools/plant/nominal_controller.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr double kDuration_s = 0.8;         // longer than a first stride
constexpr double kSoft_N_per_m = 300.0;     // a leg softer than this is released from low heights only
constexpr double kHighestForSoft_m = 0.04;  // from higher up a soft leg runs into its stop

struct Hop {
  double height_m, stiffness_N_per_m;
};

// Phase of the believed controller at each of its cycles, along a simulated motion.
std::vector<double> phases_of(const WorldConfig& world, const Hop& hop, const HopperTraces& traces) {
  NominalController controller(world.controller, hop.stiffness_N_per_m);
  const Leg leg(world.robot.leg);
  Signal rate = traces.rate_radps;
  rate.low_pass(1.0 / (2.0 * std::numbers::pi * world.sensors.encoder_velocity_bandwidth_Hz));
  std::vector<double> phases;
  const double tick_s = 1.0 / world.controller.rate_Hz;
  for (double t = 0.0; t <= kDuration_s + tick_s; t += tick_s) {
    controller.step(leg, {traces.foot_z_m.at(t), traces.angle_rad.at(t), rate.at(t)});
    phases.push_back(static_cast<double>(controller.phase()));
  }
  return phases;
}

// The first stride's end: the apex after liftoff.
double end_of(const std::vector<double>& phases, double tick_s, const HopperTraces& traces) {
  bool stance = false;
  for (std::size_t i = 0; i < phases.size(); ++i) {
    const double t = tick_s * static_cast<double>(i);
    stance = stance || phases[i] > 0.0;
    if (stance && phases[i] == 0.0 && traces.foot_velocity_mps.at(t) < 0.0) return t;
  }
  return kDuration_s;
}

DoableTrial planned(const Trial& sample, const Belief& belief, const Edits& edits, const PlantState& release,
                    const Hop& hop) {
  HopperRun run;
  run.world = world_of(belief, edits);
  run.compression_stiffness_N_per_m = hop.stiffness_N_per_m;
  run.start = release;
  run.start.foot_z_m = hop.height_m;
  run.to_s = kDuration_s;
  const HopperTraces traces = simulate_hopper(run, edits);
  const auto phases = phases_of(run.world, hop, traces);
  const double motors = run.world.robot.leg.motor_count, g = run.world.gravity_mps2;
  const double torque_constant = run.world.motor.torque_constant_Nm_per_A,
               tick_s = 1.0 / run.world.controller.rate_Hz;
  DoableTrial one;
  one.belief = belief;
  one.trial =
      recorded_like(sample, end_of(phases, tick_s, traces), [&](const std::string& channel, double t) {
        if (channel == "phase")
          return phases[std::min(phases.size() - 1, static_cast<std::size_t>(std::round(t / tick_s)))];
        if (channel.ends_with("_position_rad")) return traces.angle_rad.at(t);
        if (channel.ends_with("_velocity_radps")) return traces.rate_radps.at(t);
        if (channel.ends_with("_current_A"))
          return traces.current_torque_Nm.at(t) / (motors * torque_constant);
        if (channel.ends_with("_torque_Nm")) return traces.command_torque_Nm.at(t) / motors;
        if (channel == "imu_body_accel_z_mps2") return traces.body_accel_mps2.at(t) + g;
        if (channel == "imu_foot_accel_z_mps2") return traces.foot_accel_mps2.at(t) + g;
        if (channel == "tof_height_m" || channel == "mocap_body_z_m") return traces.body_z_m.at(t);
        if (channel == "mocap_foot_z_m") return traces.foot_z_m.at(t);
        if (channel == "load_cell_force_N") return traces.force_N.at(t);
        return 0.0;
      });
  one.trial.kind = "hop";
  one.trial.setup = {{"release_height_m", hop.height_m},
                     {"compression_stiffness_N_per_m", hop.stiffness_N_per_m}};
  return one;
}

}  // namespace

std::vector<DoableTrial> doable_hops(const std::vector<Trial>& recorded, const Belief& belief,
                                     const Edits& edits, const Reach& reach) {
  std::vector<DoableTrial> trials;
  const auto sample = std::find_if(recorded.begin(), recorded.end(), [](const Trial& trial) {
    return trial.kind == "hop" && trial.setup.contains("release_height_m");
  });
  const WorldConfig world = world_of(belief, {});
  if (sample == recorded.end() || world.terrain.rigid) return trials;
  const auto course = course_of(*sample, Leg(world.robot.leg), world.controller.compression_length_m);
  if (course.hops.empty() || !course.hops.front().at_rest) return trials;
  const auto heights = extent_of(recorded, "release_height_m", 0.05);
  auto release_heights = reach.settings("release_height_m", {0.01, 0.03, 0.05, 0.08, 0.12});
  if (release_heights.empty()) release_heights = {heights.high};
  // The leg's stiffness is a number of the controller, so any is in reach unless the campaign lists some.
  const auto stiffnesses =
      reach.with_free_numbers().settings("compression_stiffness_N_per_m", {250.0, 375.0, 500.0});
  for (const double stiffness : stiffnesses)
    for (const double height_m : release_heights) {
      if (stiffness < kSoft_N_per_m && height_m > kHighestForSoft_m) continue;
      trials.push_back(planned(*sample, belief, edits, course.hops.front().state, {height_m, stiffness}));
      trials.back().cost = std::max(0.0, std::log2(height_m / heights.high));
    }
  return trials;
}

}  // namespace sandhopper::diagnose
