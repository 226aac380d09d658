#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "firmware/controller.hpp"
#include "tests/faults/setup.hpp"
#include "tools/faults/bench_board.hpp"

// No fault may be raised if nothing is broken: hops on beds from very soft to rigid, with each spring of the
// paper, from low to high drops, one without noise and five with different noise, offsets and beds. Two
// alarms are correct: a soft spring and a high drop drive the leg beyond its limit, as the true angle shows;
// and on rigid ground an impact beyond the accelerometers' range can leave a lasting error of the estimate,
// as the true height shows.
namespace sandhopper::faults {
namespace {

struct Hop {
  double bed_N_per_m;  // 0: rigid ground
  double spring_N_per_m;
  double drop_m;
  bool noise;
  std::uint64_t seed;
};

struct Outcome {
  Event fault{};  // kind fault_raised, or none
  State before = State::idle;
  State state = State::idle;
  EventKind last = EventKind::armed;
  int strides = 0;
  double largest_angle_rad = 0.0;  // true angle
  double smallest_angle_rad = 3.0;
  double height_error_m = 0.0;  // of the estimate, when the fault is raised
};

Outcome run(const Hop& hop, const RobotConfig& shipped) {
  auto robot = shipped;
  robot.controller.compression_stiffness_N_per_m = hop.spring_N_per_m;
  WorldConfig world_config;
  if (hop.bed_N_per_m > 0.0) world_config.terrain.stiffness_N_per_m = hop.bed_N_per_m;
  world_config.terrain.rigid = hop.bed_N_per_m == 0.0;
  World world(world_config, {.release_height_m = hop.drop_m, .seed = hop.seed, .noise = hop.noise}, 0);
  BenchBoard board(world, robot, hop.seed);
  Controller controller(cycle_config(robot));
  SensorFrame frame;
  Outcome out;
  Request request = Request::none;
  for (std::uint64_t k = 1; k < 12000; ++k) {
    frame.time_ns = static_cast<std::int64_t>(k) * 1'000'000;
    frame.cycle = k;
    frame.request = k == 300 ? Request::arm : request;
    request = Request::none;
    board.read(frame);
    out.largest_angle_rad = std::max(out.largest_angle_rad, world.truth().leg_angle_rad);
    out.smallest_angle_rad = std::min(out.smallest_angle_rad, world.truth().leg_angle_rad);
    const auto before = out.state;
    const auto& output = controller.step(frame);
    board.write(output.command);
    out.state = output.state;
    for (const auto& event : controller.events()) {
      if (event.kind == EventKind::armed) request = Request::release;
      out.strides += event.kind == EventKind::liftoff;
      out.last = event.kind;
      if (event.kind == EventKind::fault_raised) {
        out.fault = event;
        out.height_error_m = output.estimate.body_z_m - world.truth().body_z_m;
        out.before = before;
        return out;
      }
      if (event.kind == EventKind::stopped) return out;
    }
  }
  return out;
}

// A correct end: rest; or leg_angle_limit if the true angle exceeded its limit; or estimate_diverged if the
// height was wrong by more than the filter's gate.
bool right(const Outcome& out, const RobotConfig& robot) {
  constexpr double kReading_rad = 0.02;  // tolerance: change of the angle within 1 ms, the age of a reading
  const double over_rad = std::max(out.largest_angle_rad - robot.limits.leg_angle_max_rad,
                                   robot.limits.leg_angle_min_rad - out.smallest_angle_rad);
  if (out.fault.fault == Fault::leg_angle_limit) return over_rad > -kReading_rad;
  const auto& kalman = robot.estimator.kalman;
  if (out.fault.fault == Fault::estimate_diverged)
    return std::abs(out.height_error_m) > kalman.tof_gate_sigma * kalman.tof_noise_m;
  return out.fault.fault == Fault::none && out.last == EventKind::stopped && over_rad < kReading_rad;
}

void print(const Hop& hop, const Outcome& out) {
  std::printf(
      "  bed %4.0f N/m, spring %3.0f N/m, drop %.2f m, seed %d: %s (%.4g, %.4g) in %s after %d strides\n",
      hop.bed_N_per_m, hop.spring_N_per_m, hop.drop_m, static_cast<int>(hop.seed),
      std::string(name_of(out.fault.fault)).c_str(), out.fault.values[0], out.fault.values[1],
      std::string(name_of(out.before)).c_str(), out.strides);
}

TEST(SoundHops, ComeToRestWithoutAFault) {
  const auto robot = shipped_setup().robot;
  int hops = 0, wrong = 0, bent_too_far = 0, diverged = 0, without_liftoff = 0;
  for (const double bed : {600.0, 1200.0, 2400.0, 3600.0, 0.0})
    for (const double spring : {250.0, 375.0, 500.0})
      for (const double drop : {0.02, 0.05, 0.10, 0.15, 0.22})
        for (const std::uint64_t seed : {0u, 1u, 2u, 3u, 4u, 5u}) {
          const Hop hop{bed, spring, drop, seed != 0, seed};
          const auto out = run(hop, robot);
          ++hops;
          bent_too_far += out.fault.fault == Fault::leg_angle_limit;
          if (out.fault.fault == Fault::estimate_diverged) {
            ++diverged;
            EXPECT_EQ(bed, 0.0) << "only an impact on rigid ground goes beyond the accelerometers";
            std::printf("  estimate off by %+.3f m: ", out.height_error_m);
            print(hop, out);
          }
          without_liftoff += out.strides == 0;
          if (right(out, robot)) continue;
          ++wrong;
          print(hop, out);
        }
  std::printf(
      "%d hops: %d wrong; %d bent the leg past its limit and say so; %d lost the estimate on rigid ground "
      "and "
      "say so; %d came to rest without a liftoff\n",
      hops, wrong, bent_too_far, diverged, without_liftoff);
  EXPECT_EQ(wrong, 0);
  // The sweep must go beyond what the robot can do at both ends.
  EXPECT_GE(bent_too_far, 3);
  EXPECT_LE(bent_too_far, 20);
  EXPECT_GE(without_liftoff, 5);
  EXPECT_LE(diverged, 10);
}

// A command of the MIT dialect cannot code zero velocity: half a count remains, which is 0.7 rad in a minute.
TEST(SoundHops, ARobotThatHangsForAMinuteIsLeftAlone) {
  for (const auto dialect : {Dialect::mit, Dialect::servo, Dialect::v3}) {
    auto robot = shipped_setup().robot;
    for (auto& motor : robot.motor) motor.dialect = dialect;
    World world(WorldConfig{}, {}, 0);
    BenchBoard board(world, robot, 1);
    Controller controller(cycle_config(robot));
    SensorFrame frame;
    Fault fault = Fault::none;
    for (std::uint64_t k = 1; k < 60'000 && fault == Fault::none; ++k) {
      frame.time_ns = static_cast<std::int64_t>(k) * 1'000'000;
      frame.cycle = k;
      frame.request = k == 30'000 ? Request::arm : Request::none;
      board.read(frame);
      const auto& output = controller.step(frame);
      board.write(output.command);
      fault = output.fault;
    }
    EXPECT_EQ(fault, Fault::none) << name_of(dialect) << ": " << name_of(fault) << " after " << frame.cycle
                                  << " ms";
  }
}

}  // namespace
}  // namespace sandhopper::faults
