#pragma once
#include <cmath>
#include <functional>
#include <string>

#include "tools/diagnose/engine.hpp"
#include "tools/plant/random.hpp"

// Small campaigns in memory for the tests of the diagnosis. Their own integrator (semi-implicit, 20 us),
// apart from the one under test.
namespace sandhopper::diagnose {

using BodyForce = std::function<double(double t_s, double height_m, double velocity_mps)>;

// Drops of a 0.2 kg body from 2 to 7 m, height at 100 Hz with 3 mm of noise, accelerometer at 200 Hz with
// 0.05 m/s^2; `force_N` is what the belief does not know.
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

// A pendulum of 0.1 kg m^2 and 2 N m moved by sums of sines for 2.5 s, position and velocity at 250 Hz.
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

}  // namespace sandhopper::diagnose
