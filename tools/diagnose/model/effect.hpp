#pragma once
#include <cmath>
#include <functional>
#include <initializer_list>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "tools/diagnose/model/context.hpp"
#include "tools/diagnose/model/edits.hpp"

namespace sandhopper::diagnose {

// A number of an effect. `value = 0` for the first parameter switches the effect off; others only shape it,
// unless they are amplitudes, too. What is reported is base + scale * value, so that a parameter that bears
// the name of a nominal.toml key reads like that key.
struct EffectParameter {
  std::string name{};  // with unit
  double typical = 1.0;
  double low = 0.0;
  double high = 1.0;
  bool either_sign = false;  // starts are tried on both sides
  double base = 0.0;
  double scale = 1.0;            // 0: read off the data and not fitted, to within
  double resolution = 0.0;       //   this
  bool amplitude = false;        // besides the first: zero switches this part off, too
  double power = 1.0;            // reported as (base + scale * value)^power
  bool other_law_above = false;  // at its upper bound this is not the effect any more
  // Of a shape: values worth a start of their own. Of what switches it off: sizes at which its signature is
  // taken, too, where another size acts elsewhere.
  std::vector<double> shapes{};

  double reported(double value) const {
    const double plain = base + scale * value;
    return power == 1.0 ? plain : std::pow(plain, power);
  }
  // The other way; a limit that is read off the data is in place or not.
  double value_of(double reported) const {
    if (scale == 0.0) return typical;
    return ((power == 1.0 ? reported : std::pow(reported, 1.0 / power)) - base) / scale;
  }
  // How many typical sizes a value is.
  double typicals(double value) const {
    const double plain = std::abs(value) / typical;
    return power > 0.0 && power != 1.0 ? std::pow(plain, power) : plain;
  }
};

// Where an effect of `port` acts on this plant: a rotary axis' only joint is the axis.
Port port_on(PlantKind plant, Port port);

// Whether zero switches it, or its part of the effect, off; the others are shapes.
inline bool is_amplitude(const std::vector<EffectParameter>& parameters, std::size_t index) {
  return index == 0 || parameters[index].amplitude;
}

// A piece of physics, or a fault of a sensor, that a simulation may lack.
//
// One file in effects/ each, which registers it; its test says that it acts and is found when alone.
struct Effect {
  std::string id{};  // port.effect, as the design's list has it
  Port port{};
  std::string statement{};  // one sentence; {channel} stands for the channel of a sensor's fault
  std::string equation{};
  std::vector<std::string> same_as{};  // other names of what does just this to the recordings
  std::vector<PlantKind> plants{};
  // Channels whose sensor may have it, each a candidate of its own; null for physics.
  std::function<std::vector<std::string>(const Context&)> channels{};
  // Empty where this campaign cannot have it.
  std::function<std::vector<EffectParameter>(const Context&, const std::string& channel)> parameters{};
  std::function<void(const Context&, const std::string& channel, std::span<const double> values,
                     Edits& edits)>
      apply{};
  std::string belief_key{};  // of nominal.toml, when the effect is a change of one number there
  // Puts the effect into the numbers of nominal.toml ("table.key") where it takes several of them; false
  // where they cannot say it. Null: `belief_key`, or [effects].
  std::function<bool(const Context&, std::span<const double> values, std::map<std::string, double>& numbers)>
      as_keys{};
};

class EffectRegistration {
 public:
  explicit EffectRegistration(Effect effect);
};

// In alphabetical order of their ids.
std::vector<Effect> known_effects();

// An effect as it may be in one campaign.
struct Candidate {
  const Effect* effect = nullptr;
  std::string channel;
  std::vector<EffectParameter> parameters;
  Port port{};  // where the effect acts on this plant

  // The part of a typical size at which its signature is taken: a law where it acts in earnest, but a change
  // of time, reading, torque or inertia by its tangent, or the steep edges of a signal, or friction that
  // gives way, hide it behind its own curvature.
  double probe() const {
    const Port port = effect->port;
    return port == Port::sensor || port == Port::clock || port == Port::actuator || port == Port::inertia
               ? 0.02
               : 0.4;
  }

  std::string label() const { return channel.empty() ? effect->id : effect->id + "[" + channel + "]"; }
};

// Where it acts, for the reader: the effect's port, or the channel whose sensor has it.
std::string port_of(const Candidate& candidate);

std::vector<Candidate> candidates_for(const std::vector<Effect>& effects, const Context& context);

}  // namespace sandhopper::diagnose
