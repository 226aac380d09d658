#pragma once
#include <cstdint>
#include <optional>

#include "terrain/bed.hpp"
#include "tools/plant/drive.hpp"
#include "tools/plant/sensors.hpp"
#include "tools/plant/world_config.hpp"

namespace sandhopper {

// Random draws that differ between trials, made once per seed: bed, drives and sensors of that trial, from
// the configuration's noise and spread. Every quantity has its own random stream, and draws are limited to
// three sigma. Without noise all values are nominal.
class TrialDraw {
 public:
  struct Setup {
    std::uint64_t seed;
    bool noise;
    std::int64_t start_ns;
    std::optional<std::uint64_t> robot_seed{};  // of the torque constant's error; none: `seed`
  };
  TrialDraw(const WorldConfig& config, const Setup& setup) : config_(config), setup_(setup) {}

  struct Release {
    double height_m = 0.0;  // added to the nominal release height
    double speed_mps = 0.0;
    double surface_height_m = 0.0;  // height of the bed in the laboratory's frame
  };
  Release release() const;
  double cable_force_N() const;

  Bed bed() const;
  BedFamilyParameters bed_family() const;
  Drive drive(Side side) const;
  Imu imu_body() const;
  Imu imu_foot() const;
  TimeOfFlight tof() const;
  LoadCell load_cell() const;
  Mocap mocap() const;

 private:
  SampleClock::Setup clock(double rate_Hz, double error_relative, Random& random) const;
  Imu imu(std::uint64_t spread_stream, std::uint64_t noise_stream) const;

  const WorldConfig& config_;
  Setup setup_;
};

}  // namespace sandhopper
