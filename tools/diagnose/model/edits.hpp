#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/diagnose/model/ports.hpp"
#include "tools/diagnose/model/states.hpp"

namespace sandhopper::diagnose {

// One change of a measurement, from the true quantity to the recorded one. The recorded torque or current
// that drives a plant passes the same edits from recorded to acting, under the channel name "actuator".
struct SensorEdit {
  // Meaning of `value`: a factor (gain, time_scale), a number in the channel's unit (offset, clip_*), a time
  // in s (lag_s, delay_s) or a share (mean_share).
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
  // Only for mean_share: the reading is (1 - value) x + value times the mean of x over this centred window
  double window_s = 0.0;
  Law law{};  // only for kind law: added to the reading
  // Identifies `law` for caching, because functions cannot be compared; 0: unknown
  std::uint64_t law_key = 0;
};

// A number of the belief becomes value * factor + addend.
struct BeliefEdit {
  std::string key;
  double factor = 1.0;
  double addend = 0.0;

  bool operator==(const BeliefEdit&) const = default;
};

// All changes that a set of effects makes to a simulation. Empty: the model as believed.
struct Edits {
  std::vector<BeliefEdit> belief;
  std::vector<std::pair<LawPort, Law>> laws;
  std::vector<SensorEdit> sensors;
  // Identifies `laws` for caching: equal keys mean equal laws. 0: unknown.
  std::uint64_t laws_key = 0;

  void scale(std::string key, double factor);
  void add(std::string key, double addend);
  // Adds `law` at the port: a function of the port's state (states.hpp) or of any PortState.
  template <class F>
  void law(LawPort port, F law) {
    laws.emplace_back(port, law_of(std::move(law)));
  }
  void sensor(std::string channel, SensorEdit::Kind kind, double value, double window_s = 0.0);
  template <class F>
  void sensor_law(std::string channel, F law) {
    add_sensor_law(std::move(channel), law_of(std::move(law)));
  }

  // `value` of the key after all edits of that key, in their order.
  double edited(std::string_view key, double value) const {
    for (const auto& edit : belief)
      if (edit.key == key) value = value * edit.factor + edit.addend;
    return value;
  }
  std::vector<const Law*> at(LawPort port) const {
    std::vector<const Law*> found;
    for (const auto& [name, law] : laws)
      if (name == port) found.push_back(&law);
    return found;
  }

 private:
  void add_sensor_law(std::string channel, Law law);
};

// Sum of the laws at one state, in the port's unit (ports.hpp).
inline double sum_of(const std::vector<const Law*>& laws, const PortState& state) {
  double sum = 0.0;
  for (const auto* law : laws) sum += (*law)(state);
  return sum;
}

// Clock of a sensor: a reading with stamp t was taken at rate * t - late_s.
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
