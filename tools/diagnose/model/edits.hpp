#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sandhopper::diagnose {

// What a port shows to a law that acts there. Falling body, rail: height or position and velocity, up
// positive. Axis, joint: angle and angular velocity; `load` the drive's torque, `extreme` where an axis last
// turned. Ground: depth, downward speed and acceleration; `load` the quasi-static force, `extreme` the
// deepest point; of the bed how often pushed, how long it waited since prepared, how deep (0: not told);
// "foot.size" the plate's radius as position, its law the logarithm of a factor on the depth law. Sensor: the
// value as position, its rate as velocity. Actuator: the current's torque as position, the motors'
// temperature.
struct PortState {
  double time_s = 0.0;
  double position = 0.0;
  double velocity = 0.0;
  double accel = 0.0;
  double load = 0.0;
  double bearing = 0.0;
  double extreme = 0.0;
  double temperature_C = 25.0;
  double pushes = 0.0;
  double wait_s = 0.0;
  double bed_depth_m = 0.0;
  double since_touch_s = 0.0;
};
using Law = std::function<double(const PortState&)>;

// One change of the way from a true quantity to a recorded one. Torque and current that drive the plant pass
// the same way from "recorded" to "acting": they are the channel "actuator".
struct SensorEdit {
  enum class Kind : std::uint8_t {
    gain,
    offset,
    lag_s,
    delay_s,
    time_scale,
    clip_high,
    clip_low,
    mean_share,
    law
  };
  std::string channel;
  Kind kind{};
  double value = 0.0;
  double window_s = 0.0;      // of mean_share: what is recorded is by this share the mean over it, centred
  Law law{};                  // added to the value
  std::uint64_t law_key = 0;  // tells laws apart, which cannot be compared; 0: not known
};

struct BeliefEdit {
  std::string key;
  double factor = 1.0;
  double addend = 0.0;
};

// Everything a set of effects changes in a simulation; empty is the belief as it stands.
struct Edits {
  std::vector<BeliefEdit> belief;
  std::vector<std::pair<std::string, Law>> laws;  // port, force or torque added there
  std::vector<SensorEdit> sensors;
  // Edits with the same key hold the same laws at ports. 0: not known.
  std::uint64_t laws_key = 0;

  void scale(std::string key, double factor);
  void add(std::string key, double addend);
  void law(std::string port, Law law);
  void sensor(std::string channel, SensorEdit::Kind kind, double value, double window_s = 0.0);
  void sensor_law(std::string channel, Law law);

  double edited(std::string_view key, double value) const {
    for (const auto& edit : belief)
      if (edit.key == key) value = value * edit.factor + edit.addend;
    return value;
  }
  std::vector<const Law*> at(std::string_view port) const {
    std::vector<const Law*> found;
    for (const auto& [name, law] : laws)
      if (name == port) found.push_back(&law);
    return found;
  }
};

inline double sum_of(const std::vector<const Law*>& laws, const PortState& state) {
  double sum = 0.0;
  for (const auto* law : laws) sum += (*law)(state);
  return sum;
}

// When a sensor's reading with a given stamp was taken: taken = rate stamp - late.
struct SensorClock {
  SensorClock(const Edits& edits, std::string_view channel, double latency_s = 0.0) : late_s(latency_s) {
    for (const auto& edit : edits.sensors) {
      if (edit.channel != channel) continue;
      if (edit.kind == SensorEdit::Kind::time_scale) rate *= edit.value;
      if (edit.kind == SensorEdit::Kind::delay_s) late_s += edit.value;
    }
  }
  double taken_s(double stamp_s) const { return stamp_s * rate - late_s; }
  double stamp_s(double taken_s) const { return (taken_s + late_s) / rate; }

  double rate = 1.0, late_s = 0.0;
};

}  // namespace sandhopper::diagnose
