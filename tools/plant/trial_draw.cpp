#include "tools/plant/trial_draw.hpp"

#include <algorithm>

namespace sandhopper {
namespace {

// Numbers of the random streams. A new one goes to the end, so that the others keep their numbers.
enum Stream : std::uint64_t {
  kBedStiffness,
  kBedFluctuation,
  kRelease,
  kEncoderLeft,
  kEncoderRight,
  kCurrentLeft,
  kCurrentRight,
  kDriveSpread,
  kImuBody,
  kImuFoot,
  kImuBodySpread,
  kImuFootSpread,
  kTof,
  kTofSpread,
  kLoadCell,
  kLoadCellSpread,
  kMocap,
  kMocapSpread,
  kCable,
  kBedFamily,
};

constexpr double kLeastExponent = 0.1;       // lower limit of the configuration
constexpr double kLeastFloor_m = 1e-3;       // zero would mean no floor
constexpr double kQuietPhase_periods = 0.5;  // phase of every sample clock when noise is off

double limited_normal(Random& random) { return std::clamp(random.normal(), -3.0, 3.0); }

}  // namespace

TrialDraw::Release TrialDraw::release() const {
  if (!setup_.noise) return {};
  Random random(setup_.seed, kRelease);
  Release r;
  r.height_m = config_.spread.release_height_m * limited_normal(random);
  r.speed_mps = config_.spread.release_speed_mps * limited_normal(random);
  r.surface_height_m = config_.spread.surface_height_m * limited_normal(random);
  return r;
}

double TrialDraw::cable_force_N() const {
  Random random(setup_.seed, kCable);
  return setup_.noise ? config_.spread.cable_force_N * limited_normal(random) : 0.0;
}

Bed TrialDraw::bed() const {
  BedParameters terrain = config_.terrain;
  BedFluctuation fluctuation;
  if (setup_.noise) {
    Random stiffness(setup_.seed, kBedStiffness);
    const double factor = 1.0 + config_.spread.bed_stiffness_relative * limited_normal(stiffness);
    terrain.stiffness_N_per_m *= factor;
    terrain.stiffness_per_area_N_per_m3 *= factor;
    fluctuation.relative = config_.spread.bed_fluctuation_relative;
    fluctuation.spacing_m = config_.spread.bed_fluctuation_length_m;
    Random along_depth(setup_.seed, kBedFluctuation);
    for (auto& knot : fluctuation.knots) knot = limited_normal(along_depth);
  }
  return {terrain, config_.robot.leg.foot_radius_m, fluctuation, bed_family()};
}

BedFamilyParameters TrialDraw::bed_family() const {
  BedFamilyParameters family = config_.bed_family;
  if (!setup_.noise) return family;
  Random random(setup_.seed, kBedFamily);
  const auto spread = [&] { return 1.0 + family.strength_spread_relative * limited_normal(random); };
  family.deep_strength_ratio = 1.0 + (family.deep_strength_ratio - 1.0) * spread();
  for (double* strength : {&family.crust_shear_strength_Pa, &family.cohesion_Pa, &family.suction_Pa})
    *strength *= spread();
  for (double* depth : {&family.boundary_depth_m, &family.crust_depth_m})
    *depth = std::max(0.0, *depth + family.depth_spread_m * limited_normal(random));
  if (family.floor_depth_m > 0.0)
    family.floor_depth_m =
        std::max(kLeastFloor_m, family.floor_depth_m + family.depth_spread_m * limited_normal(random));
  family.exponent =
      std::max(kLeastExponent, family.exponent + family.exponent_spread * limited_normal(random));
  return family;
}

// The error of the torque constant comes from the magnets and the convention, so it is equal for both motors.
Drive TrialDraw::drive(Side side) const {
  const bool left = side == Side::left;
  Drive::Imperfection imperfection{.noisy = setup_.noise};
  if (setup_.noise) {
    Random robot(setup_.robot_seed.value_or(setup_.seed), kDriveSpread), random(setup_.seed, kDriveSpread);
    imperfection.torque_constant_relative = config_.spread.torque_constant_relative * limited_normal(robot);
    random.normal();  // this number is the torque constant's if the robot has no seed of its own
    const double offset_left_A = config_.spread.current_offset_A * limited_normal(random);
    const double offset_right_A = config_.spread.current_offset_A * limited_normal(random);
    imperfection.current_offset_A = left ? offset_left_A : offset_right_A;
  }
  return {config_, imperfection,
          Drive::Noise{.encoder = Random(setup_.seed, left ? kEncoderLeft : kEncoderRight),
                       .current = Random(setup_.seed, left ? kCurrentLeft : kCurrentRight)}};
}

SampleClock::Setup TrialDraw::clock(double rate_Hz, double error_relative, Random& random) const {
  if (!setup_.noise) return {rate_Hz, 0.0, kQuietPhase_periods};
  const double phase_periods = 1.0 - random.uniform();
  return {rate_Hz, error_relative * limited_normal(random), phase_periods};
}

Imu TrialDraw::imu(std::uint64_t spread_stream, std::uint64_t noise_stream) const {
  const auto& sensor = config_.sensors;
  const auto& spread = config_.spread;
  Random random(setup_.seed, spread_stream);
  const auto timing = clock(sensor.imu_rate_Hz, spread.imu_clock_relative, random);
  Imu::Setup imu{.bandwidth_Hz = sensor.imu_bandwidth_Hz, .range_mps2 = sensor.imu_range_mps2};
  if (setup_.noise) {
    imu.noise_mps2 = sensor.imu_noise_mps2;
    imu.structure_noise_mps2 = sensor.imu_structure_noise_mps2;
    imu.resolution_mps2 = sensor.imu_resolution_mps2;
    imu.gyro_noise_radps = sensor.imu_gyro_noise_radps;
    imu.scale_relative = spread.imu_scale_relative * limited_normal(random);
    for (auto& axis : imu.raw_offset_mps2) axis = spread.imu_raw_offset_mps2 * limited_normal(random);
    for (auto& axis : imu.bias_mps2) axis = spread.imu_bias_mps2 * limited_normal(random);
    for (auto& axis : imu.gyro_bias_radps) axis = spread.imu_gyro_bias_radps * limited_normal(random);
  }
  return {imu, timing, setup_.start_ns, Random(setup_.seed, noise_stream)};
}

Imu TrialDraw::imu_body() const { return imu(kImuBodySpread, kImuBody); }
Imu TrialDraw::imu_foot() const { return imu(kImuFootSpread, kImuFoot); }

TimeOfFlight TrialDraw::tof() const {
  Random random(setup_.seed, kTofSpread);
  const auto timing = clock(config_.sensors.tof_rate_Hz, config_.spread.tof_clock_relative, random);
  TimeOfFlight::Setup tof{.latency_s = config_.sensors.tof_latency_s};
  if (setup_.noise) {
    tof.noise_m = config_.sensors.tof_noise_m;
    tof.bias_m = config_.spread.tof_bias_m * limited_normal(random);
  }
  return {tof, timing, setup_.start_ns, Random(setup_.seed, kTof)};
}

LoadCell TrialDraw::load_cell() const {
  Random random(setup_.seed, kLoadCellSpread);
  const auto timing =
      clock(config_.sensors.load_cell_rate_Hz, config_.spread.load_cell_clock_relative, random);
  LoadCell::Setup cell{.bandwidth_Hz = config_.sensors.load_cell_bandwidth_Hz};
  if (setup_.noise) {
    cell.noise_N = config_.sensors.load_cell_noise_N;
    cell.offset_N = config_.spread.load_cell_offset_N * limited_normal(random);
  }
  return {cell, timing, setup_.start_ns, Random(setup_.seed, kLoadCell)};
}

Mocap TrialDraw::mocap() const {
  Random random(setup_.seed, kMocapSpread);
  const auto timing = clock(config_.sensors.mocap_rate_Hz, 0.0, random);
  return {setup_.noise ? config_.sensors.mocap_noise_m : 0.0, timing, setup_.start_ns,
          Random(setup_.seed, kMocap)};
}

}  // namespace sandhopper
