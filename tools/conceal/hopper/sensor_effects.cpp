#include <cmath>

#include "tools/conceal/core/fault_recipes.hpp"
#include "tools/conceal/hopper/world.hpp"

namespace sandhopper::conceal::hopper {
namespace {

constexpr const char* kCell = "load_cell_force_N";
constexpr const char* kTof = "tof_height_m";

std::string either_imu(Random& random) {
  return random.chance(0.5) ? "imu_body_accel_z_mps2" : "imu_foot_accel_z_mps2";
}

Recipe<World> cell_lag() {
  return {{"load_cell.lag", "", "clock"}, [](World& w, double size, Random&) -> Json {
            w.faults[kCell].lag_s = size * 3e-3;
            return {{"time_constant_s", size * 3e-3}};
          }};
}

Recipe<World> gain(const char* id, const char* channel, double typical) {
  return {{id, "", "gain"}, [=](World& w, double size, Random& random) -> Json {
            const double error = random.sign() * size * typical;
            w.faults[channel].gain *= 1.0 + error;
            return {{"scale_error", error}};
          }};
}

Recipe<World> offset(const char* id, const char* channel, double typical, const char* parameter) {
  return {{id, "", "offset"}, [=](World& w, double size, Random& random) -> Json {
            const double value = random.sign() * size * typical;
            w.faults[channel].offset += value;
            return {{parameter, value}};
          }};
}

Json cell_inertia(World& w, double size, Random&) {
  w.hidden.load_cell_kg = size * 0.06;
  return {{"mass_kg", w.hidden.load_cell_kg}};
}

Json imu_bias(World& w, double size, Random& random) {
  const auto channel = either_imu(random);
  const double bias = random.sign() * size * 0.25;
  w.faults[channel].offset += bias;
  return {{"channel", channel}, {"bias_mps2", bias}};
}

Json imu_scale(World& w, double size, Random& random) {
  const auto channel = either_imu(random);
  const double error = random.sign() * size * 0.03;
  w.faults[channel].gain *= 1.0 + error;
  return {{"channel", channel}, {"scale_error", error}};
}

// A tilted axis measures the cosine of the acceleration.
Json imu_tilt(World& w, double size, Random& random) {
  const auto channel = either_imu(random);
  const double tilt_rad = size * 0.15;
  w.faults[channel].gain *= std::cos(tilt_rad);
  return {{"channel", channel}, {"tilt_rad", tilt_rad}};
}

Json imu_lag(World& w, double size, Random& random) {
  const auto channel = either_imu(random);
  w.faults[channel].lag_s = size * 4e-3;
  return {{"channel", channel}, {"time_constant_s", size * 4e-3}};
}

Json imu_clipping(World& w, double size, Random& random) {
  const auto channel = either_imu(random);
  w.faults[channel].limit = 25.0 / (0.7 + 0.3 * size);
  return {{"channel", channel}, {"limit_mps2", w.faults[channel].limit}};
}

Json tof_latency(World& w, double size, Random&) {
  w.faults[kTof].late_s += size * 0.012;
  return {{"latency_s", size * 0.012}};
}

Json encoder_offset(World& w, double size, Random& random) {
  w.hidden.encoder_offset_rad = random.sign() * size * 0.015;
  return {{"offset_rad", w.hidden.encoder_offset_rad}};
}

Json eccentricity(World& w, double size, Random& random) {
  w.hidden.eccentricity_rad = size * 0.02;
  w.hidden.eccentricity_phase_rad = random.uniform(0.0, 6.28);
  return {{"amplitude_rad", w.hidden.eccentricity_rad}, {"phase_rad", w.hidden.eccentricity_phase_rad}};
}

std::vector<std::string> fault_channels(const World&) {
  return {kCell, kTof, "imu_body_accel_z_mps2", "imu_foot_accel_z_mps2"};
}

}  // namespace

std::vector<Recipe<World>> sensor_effects() {
  auto all = data_fault_recipes<World>(fault_channels, 4e-3);
  append(all, {cell_lag(),
               gain("load_cell.gain", kCell, 0.05),
               offset("load_cell.offset", kCell, 0.8, "offset_N"),
               {{"load_cell.inertia", "", "inertia"}, cell_inertia},
               {{"imu.bias", "", "offset"}, imu_bias},
               {{"imu.scale", "", "gain"}, imu_scale},
               {{"imu.tilt", "", "gain"}, imu_tilt},
               {{"imu.lag", "", "clock"}, imu_lag},
               {{"imu.clipping", "", "data"}, imu_clipping},
               offset("tof.bias", kTof, 0.012, "bias_m"),
               gain("tof.scale", kTof, 0.03),
               {{"tof.latency", "", "clock"}, tof_latency},
               {{"encoder.offset", "", "geometry"}, encoder_offset},
               {{"encoder.eccentricity", "", "geometry"}, eccentricity}});
  return all;
}

}  // namespace sandhopper::conceal::hopper
