#pragma once
#include <cmath>
#include <functional>
#include <initializer_list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/diagnose/model/context.hpp"
#include "tools/diagnose/model/edits.hpp"

namespace sandhopper::diagnose {

// One parameter of an effect. The first one is an amplitude: 0 switches the effect off. Others are shapes
// unless `amplitude` is set. The report shows (base + scale * value)^power, so that a parameter with the name
// of a nominal.toml key reads like that key.
struct EffectParameter {
  std::string name{};    // with unit
  double typical = 1.0;  // a size that matters; fits work in units of it
  double low = 0.0;
  double high = 1.0;
  bool either_sign = false;  // fits start with both signs
  double base = 0.0;
  double scale = 1.0;       // 0: the reported number is `base`, read off the data
  double resolution = 0.0;  // half-width of its reported interval where scale is 0
  bool amplitude = false;   // for a later parameter: 0 switches off a part of the effect
  double power = 1.0;       // reported as (base + scale * value)^power
  // The same size as readers look for it, reported first: `other_scale` times the value under `other_name`;
  // or, for the sine part of an angle whose cosine part comes next, the amplitude of both under
  // `amplitude_name`.
  std::string other_name{};
  double other_scale = 1.0;
  std::string amplitude_name{};
  bool other_law_above = false;  // at its upper bound the law is another effect: such a fit is rejected
  // Step of a central difference, in the parameter's unit; 0: a forward difference by a small part of the
  // typical size. Where a nuisance acts on the recordings in the same way, give the nuisance's step: then
  // both have the same derivative, and one can stand in for the other without loss.
  double central_step = 0.0;
  // More values to screen. Shape: each is a separate start. Amplitude: sizes at which the derivative is taken
  // as well, because another size acts on other rows.
  std::vector<double> shapes{};
  // True: nothing lies beyond `low` and `high`, as with a share from 0 to 1. Otherwise a value at a limit is
  // reported as such, because the true one may lie beyond.
  bool is_whole_range = false;

  bool at_low(double value) const { return value <= low + 1e-9 * std::abs(low); }
  bool at_high(double value) const { return value >= high - 1e-9 * std::abs(high); }
  double reported(double value) const {
    const double plain = base + scale * value;
    return power == 1.0 ? plain : std::pow(plain, power);
  }
  // The typical size as reported; for a number that the belief holds already, its typical change. Empty for a
  // limit that is read off the data.
  std::optional<double> typical_size() const {
    if (scale == 0.0) return {};
    return power == 1.0 ? std::abs(scale) * typical : reported(typical);
  }
  // Inverse of reported(). A limit that is read off the data (scale 0) becomes fully active.
  double value_of(double reported) const {
    if (scale == 0.0) return typical;
    return ((power == 1.0 ? reported : std::pow(reported, 1.0 / power)) - base) / scale;
  }
  // Size of a value relative to the typical one, on the reported scale if power > 0.
  double typicals(double value) const {
    const double plain = std::abs(value) / typical;
    return power > 0.0 && power != 1.0 ? std::pow(plain, power) : plain;
  }
};

// Port at which an effect acts on this plant. On a rotary axis joint and body are the axis itself.
Port port_on(PlantKind plant, Port port);

// True if the value 0 switches off the effect or a part of it. The other parameters are shapes.
inline bool is_amplitude(const std::vector<EffectParameter>& parameters, std::size_t index) {
  return index == 0 || parameters[index].amplitude;
}

// A test off the usual kind of trial that tells an effect from those that resemble it. Nothing simulates it,
// so no chance is stated for it.
struct BenchTest {
  std::string kind{};  // kind of trial (guide: The recording contract); empty: the test is no recording
  // One imperative sentence, "Do this: see that.". Placeholders: {channel} of a sensor's fault; {robot} and
  // {foot} for what the plant calls them (next/bench_test.cpp).
  std::string sentence{};
  std::vector<std::string> same_for{};  // ids of effects that show in this test in the same way
  std::vector<PlantKind> plants{};      // empty: all plants of the effect
};

// A piece of physics, or a sensor fault, that a simulation may lack. Each has one file in effects/, which
// registers it, and a test that hides it in a small campaign and finds it.
struct Effect {
  std::string id{};  // "port.effect", e.g. "axis.stribeck"
  Port port{};
  std::string statement{};  // one sentence; {channel} stands for the channel of a sensor's fault
  std::string equation{};
  std::vector<BenchTest> bench_tests{};  // the first one for the plant counts; none: no such test is known
  std::vector<std::string> same_as{};    // ids of effects that change the recordings in the same way
  std::vector<PlantKind> plants{};
  // For a sensor fault: channels whose sensor may have it, each a separate candidate. Null for physics.
  std::function<std::vector<std::string>(const Context&)> channels{};
  // Parameters in this campaign, for this channel. Empty if the effect cannot occur in it.
  std::function<std::vector<EffectParameter>(const Context&, const std::string& channel)> parameters{};
  // Adds the effect with these parameter values to `edits`.
  std::function<void(const Context&, const std::string& channel, std::span<const double> values,
                     Edits& edits)>
      apply{};
  std::string belief_key{};  // key of nominal.toml, if the effect changes that one number
  // Writes the effect into the numbers of nominal.toml ("table.key") if it changes several of them. Returns
  // false if they cannot express it. Null: the corrected model uses `belief_key`, else the table [effects].
  std::function<bool(const Context&, std::span<const double> values, std::map<std::string, double>& numbers)>
      as_keys{};
};

// The effect's bench test for a plant; null if it has none.
const BenchTest* bench_test_of(const Effect& effect, PlantKind plant);

// Adds an effect to known_effects(). Each effect's file defines one at namespace scope.
class EffectRegistration {
 public:
  explicit EffectRegistration(Effect effect);
};

// All registered effects, sorted by id.
std::vector<Effect> known_effects();

// An effect that may occur in this campaign; for a sensor fault, in one channel.
struct Candidate {
  const Effect* effect = nullptr;
  std::string channel;
  std::vector<EffectParameter> parameters;
  Port port{};  // port at which the effect acts on this plant
  // True if the effect only changes numbers whose standard deviation [known_to] states. A change that the
  // statement allows is a tolerance (fit/problem.hpp), so the effect says that the statement is wrong.
  bool contradicts_belief = false;

  // Step for the derivative of the predictions with respect to the amplitude, in typical sizes. A law at a
  // port gets a large step, because it may act at a finite size only. A change of time, reading, torque or
  // inertia gets a small one: curvature at steep edges of a signal, or where friction gives way, would
  // distort a large one.
  double probe() const {
    const Port port = effect->port;
    return port == Port::sensor || port == Port::clock || port == Port::actuator || port == Port::inertia
               ? 0.02
               : 0.4;
  }

  std::string label() const { return channel.empty() ? effect->id : effect->id + "[" + channel + "]"; }
};

// Key under which the plants simulate a number of nominal.toml: a rig's stiffness as a compliance, its
// reciprocal.
std::string simulated_key(const std::string& key);

// Place of the effect in an answer: the channel with the fault, else the port, else the first part of the id.
std::string port_of(const Candidate& candidate);

// All effects that may occur in this campaign, with one candidate per channel of a sensor fault.
std::vector<Candidate> candidates_for(const std::vector<Effect>& effects, const Context& context);

}  // namespace sandhopper::diagnose
