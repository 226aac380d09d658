#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/diagnose/model/ports.hpp"
#include "tools/diagnose/model/states.hpp"

namespace sandhopper::diagnose {

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
  std::vector<std::pair<LawPort, Law>> laws;
  std::vector<SensorEdit> sensors;
  // Edits with the same key hold the same laws at ports. 0: not known.
  std::uint64_t laws_key = 0;

  void scale(std::string key, double factor);
  void add(std::string key, double addend);
  // `law`: a function of the port's state, or of any.
  template <class F>
  void law(LawPort port, F law) {
    laws.emplace_back(port, law_of(std::move(law)));
  }
  void sensor(std::string channel, SensorEdit::Kind kind, double value, double window_s = 0.0);
  template <class F>
  void sensor_law(std::string channel, F law) {
    add_sensor_law(std::move(channel), law_of(std::move(law)));
  }

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
