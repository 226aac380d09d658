#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "drivers/samples.hpp"
#include "firmware/command.hpp"
#include "tools/plant/drive.hpp"
#include "tools/plant/fixture.hpp"
#include "tools/plant/plant.hpp"
#include "tools/plant/plant_truth.hpp"
#include "tools/plant/sensors.hpp"
#include "tools/plant/world_config.hpp"

namespace sandhopper {

class TrialDraw;

// One trial of the simulated robot. `noise = false` switches off everything random (noise, offsets, spread,
// clock errors, rounding); rates, bandwidths, latencies and ages remain.
struct TrialSetup {
  double release_height_m = 0.0618;
  std::uint64_t seed = 1;
  bool noise = true;
  bool bed_memory = true;  // later strides land in the crater of earlier ones
  // Seed of the robot: trials with the same one have the same error of the torque constant. Without it that
  // error is drawn for each trial.
  std::optional<std::uint64_t> robot_seed{};
};

// Cycles from arming to release in a simulated trial. The height filter starts with a spread of 10 mm; after
// less time than this, its height still changes in the stance.
inline constexpr std::int64_t kHang_cycles = 100;

// Robot, bed and sensors. Their time advances on a 0.1 ms grid from `start_ns`, and only in advance_to().
// Until open_catch() the catch holds the robot: foot at the release height, leg at its flight length; the
// motors produce torque but nothing moves. Equal seeds give equal bits; the result does not depend on how
// often a sensor is read.
class World {
 public:
  static constexpr std::int64_t kStep_ns = 100'000;

  // Throws std::invalid_argument if the leg is impossible or the release height puts the foot into the bed.
  World(const WorldConfig& config, const TrialSetup& setup, std::int64_t start_ns);

  std::int64_t now_ns() const noexcept { return now_ns_; }

  // Steps plant and sensors up to the last grid point <= time_ns; a time in the past does nothing.
  void advance_to(std::int64_t time_ns) noexcept;

  // The body is free from the next step on.
  void open_catch() noexcept;

  // The fixture acts from the next step on, until the body is released.
  void hold(const Fixture& fixture) noexcept;

  // Acts from the next step until the next command; not enabled means no torque.
  void command(Side side, const MotorCommand& command, bool enabled) noexcept;

  // Present measurement of the drive.
  MotorSample read_motor(Side side) const noexcept;

  // Newest completed sample; time_ns = 0 before the first.
  const ImuSample& imu_body() const noexcept { return imu_body_.sample(); }
  const ImuSample& imu_foot() const noexcept { return imu_foot_.sample(); }
  const TofSample& tof() const noexcept { return tof_.sample(); }
  const LoadCellSample& load_cell() const noexcept { return load_cell_.sample(); }

  // Earliest grid time at which one of these four samples changes.
  std::int64_t next_sample_ns() const noexcept;

  // Exact instant of each sensor's next sample.
  struct NextSamples {
    std::int64_t imu_body_ns, imu_foot_ns, tof_ns, load_cell_ns;
  };
  NextSamples next_samples() const noexcept {
    return {imu_body_.next_sample_ns(), imu_foot_.next_sample_ns(), tof_.next_sample_ns(),
            load_cell_.next_sample_ns()};
  }

  const PlantTruth& truth() const noexcept { return truth_; }
  const Plant& plant() const noexcept { return plant_; }

 private:
  World(const WorldConfig& config, const TrialSetup& setup, const TrialDraw& draw, std::int64_t start_ns);

  void step() noexcept;
  void take_truth() noexcept;
  void swing_leg() noexcept;
  void take_held_truth() noexcept;
  double motor_torque_Nm() const noexcept;

  double gravity_mps2_;
  double release_speed_mps_;
  double surface_height_m_;
  std::size_t motors_;
  double joint_friction_Nm_;  // sum of all motors
  std::int64_t start_ns_;
  std::int64_t now_ns_;
  Fixture fixture_{};
  std::int64_t fixture_ns_ = 0;
  double held_angle_rad_ = 0.0;
  PressedTorque pressed_{};
  Plant plant_;
  std::array<Drive, kMotorCount> drive_;
  Imu imu_body_;
  Imu imu_foot_;
  TimeOfFlight tof_;
  LoadCell load_cell_;
  Mocap mocap_;
  PlantTruth truth_{};
};

}  // namespace sandhopper
