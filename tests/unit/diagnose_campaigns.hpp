#pragma once
#include <cmath>
#include <functional>
#include <string>

#include "tools/diagnose/engine.hpp"
#include "tools/plant/random.hpp"

// Small campaigns in memory for the tests of the diagnosis. They have their own integrator (semi-implicit, 20
// us), independent of the one under test.
namespace sandhopper::diagnose {

using BodyForce = std::function<double(double t_s, double height_m, double velocity_mps)>;

// Drops of a body of 0.2 kg from 2 to 7 m; height at 100 Hz with 3 mm of noise, accelerometer at 200 Hz with
// 0.05 m/s^2. `force_N`: a force that the belief does not contain.
inline Recordings drops(const BodyForce& force_N, std::uint64_t seed = 1, std::size_t trials = 8,
                        double height_scale = 1.0) {
  constexpr double kMass_kg = 0.2, kGravity_mps2 = 9.81, kStep_s = 2e-5;
  Recordings r;
  r.plant = PlantKind::falling_body;
  r.belief.numbers = {{"gravity_mps2", kGravity_mps2},    {"body.mass_kg", kMass_kg},
                      {"body.frontal_area_m2", 0.01},     {"body.volume_m3", 7e-4},
                      {"medium.density_kg_per_m3", 1.2},  {"spread.release_height_m", 0.005},
                      {"spread.release_speed_mps", 0.01}, {"sensors.height_noise_m", 0.003},
                      {"sensors.accel_noise_mps2", 0.05}};
  for (std::size_t i = 0; i < trials; ++i) {
    Random random(seed, i);
    Trial trial;
    trial.name = std::to_string(i + 1);
    trial.kind = "drop";
    const double release_m = 2.0 + 5.0 * static_cast<double>(i % 4) / 3.0;
    trial.setup["release_height_m"] = release_m;
    double h = release_m + 0.005 * random.normal(), v = 0.01 * random.normal();
    auto& height = trial.channels["height_m"];
    auto& accel = trial.channels["accel_mps2"];
    long step = 0;
    for (double t = 0.0; h > 0.1; t += kStep_s, ++step) {
      const double a = -kGravity_mps2 + force_N(t, h, v) / kMass_kg;
      if (step % 250 == 0) {
        trial.time_s.push_back(t);
        accel.push_back(a + kGravity_mps2 + 0.05 * random.normal());
        height.push_back(step % 500 == 0 ? height_scale * h + 0.003 * random.normal() : std::nan(""));
      }
      v += a * kStep_s;
      h += v * kStep_s;
    }
    r.trials.push_back(std::move(trial));
    r.beliefs.push_back(r.belief);
  }
  return r;
}

using AxisTorque = std::function<double(double angle_rad, double velocity_radps, double torque_Nm)>;

// A pendulum of 0.1 kg m^2 and 2 N m that is driven by sums of sines for 2.5 s; position and velocity at 250
// Hz.
inline Recordings swings(const AxisTorque& unknown_Nm, std::uint64_t seed = 1, std::size_t trials = 5) {
  constexpr double kInertia_kg_m2 = 0.1, kGravityTorque_Nm = 2.0, kStep_s = 2e-5;
  Recordings r;
  r.plant = PlantKind::rotary_axis;
  r.belief.numbers = {{"axis.inertia_kg_m2", kInertia_kg_m2},
                      {"axis.gravity_torque_Nm", kGravityTorque_Nm},
                      {"axis.friction_switch_speed_radps", 0.02},
                      {"sensors.position_noise_rad", 5e-4},
                      {"sensors.velocity_noise_radps", 0.02}};
  for (std::size_t i = 0; i < trials; ++i) {
    Random random(seed, i);
    Trial trial;
    trial.name = std::to_string(i + 1);
    trial.kind = "motion";
    double angle = 0.1 * random.normal(), speed = 0.0, torque = 0.0;
    auto& position = trial.channels["position_rad"];
    auto& velocity = trial.channels["velocity_radps"];
    auto& recorded = trial.channels["torque_Nm"];
    const double rate = 1.0 + 0.3 * static_cast<double>(i);
    for (long step = 0; step < 125000; ++step) {
      const double t = kStep_s * static_cast<double>(step);
      if (step % 200 == 0) {
        torque = 1.2 * std::sin(6.2832 * 0.4 * rate * t) + 0.8 * std::sin(6.2832 * 1.1 * rate * t + 1.0);
        trial.time_s.push_back(t);
        position.push_back(angle + 5e-4 * random.normal());
        velocity.push_back(speed + 0.02 * random.normal());
        recorded.push_back(torque);
      }
      speed += kStep_s / kInertia_kg_m2 *
               (torque - kGravityTorque_Nm * std::sin(angle) + unknown_Nm(angle, speed, torque));
      angle += kStep_s * speed;
    }
    r.trials.push_back(std::move(trial));
    r.beliefs.push_back(r.belief);
  }
  return r;
}

using BedForce = std::function<double(double depth_m, double speed_mps)>;
using BedMemory = std::function<double(double since_touch_s)>;  // relative change of the quasi-static force

// A plate is pressed 30 mm into a bed of 1500 N/m and drawn out again at several speeds, recorded at 500 Hz.
// The set-ups differ in the number of earlier pushes, the waiting time and the depth of the bed.
inline Recordings presses(const BedForce& unknown_N, std::uint64_t seed = 1, std::size_t trials = 6,
                          const BedMemory& memory = {}) {
  constexpr double kStiffness_N_per_m = 1500.0, kUnloadingRatio = 30.0, kDeepest_m = 0.03, kAbove_m = 0.005;
  Recordings r;
  r.plant = PlantKind::intruder;
  r.belief.numbers = {{"gravity_mps2", 9.81},
                      {"foot.radius_m", 0.04},
                      {"terrain.stiffness_N_per_m", kStiffness_N_per_m},
                      {"terrain.intercept_depth_m", 0.0},
                      {"terrain.added_mass_factor", 0.0},
                      {"terrain.drag_factor", 0.0},
                      {"terrain.unloading_stiffness_ratio", kUnloadingRatio},
                      {"sensors.load_cell_noise_N", 0.1},
                      {"spread.surface_height_m", 1e-4},
                      {"spread.load_cell_offset_N", 0.02}};
  for (std::size_t i = 0; i < trials; ++i) {
    Random random(seed, i);
    Trial trial;
    trial.name = std::to_string(i + 1);
    trial.kind = "intrusion";
    trial.setup = {{"pushes_since_preparation", static_cast<double>(i % 3)},
                   {"wait_s", i % 2 == 0 ? 2.0 : 300.0},
                   {"bed_depth_m", i % 3 == 0 ? 0.06 : 0.045}};
    const double speed = 0.05 * std::pow(2.0, static_cast<double>(i % 4));
    const double half = 0.5 * (kDeepest_m + kAbove_m), rate = speed / half;
    const double zero_N = 0.02 * random.normal(), surface_m = 1e-4 * random.normal();
    double deepest_m = 0.0, deepest_N = 0.0, touched_s = -1.0;
    for (double t = 0.0; t < 2.0 * M_PI / rate; t += 2e-3) {
      const double z = half - kAbove_m - half * std::cos(rate * t), v = half * rate * std::sin(rate * t);
      const double depth_m = z + surface_m;
      double force_N = 0.0;
      if (depth_m > deepest_m) {
        if (touched_s < 0.0) touched_s = t;
        force_N = kStiffness_N_per_m * depth_m + unknown_N(depth_m, v);
        if (memory) force_N += kStiffness_N_per_m * depth_m * memory(t - touched_s);
        deepest_m = depth_m;
        deepest_N = kStiffness_N_per_m * depth_m;
      } else if (depth_m > 0.0) {
        force_N = std::max(0.0, deepest_N - kUnloadingRatio * kStiffness_N_per_m * (deepest_m - depth_m));
      }
      trial.time_s.push_back(t);
      trial.channels["foot_z_m"].push_back(-z);
      trial.channels["foot_velocity_mps"].push_back(-v);
      trial.channels["foot_accel_mps2"].push_back(-half * rate * rate * std::cos(rate * t));
      trial.channels["force_N"].push_back(force_N + zero_N + 0.1 * random.normal());
    }
    r.trials.push_back(std::move(trial));
    r.beliefs.push_back(r.belief);
  }
  return r;
}

}  // namespace sandhopper::diagnose
