#include "tools/diagnose/model/effect.hpp"

#include <algorithm>

namespace sandhopper::diagnose {
namespace {

std::vector<Effect>& registry() {
  static std::vector<Effect> effects;
  return effects;
}

// True if all that the effect changes are numbers under [known_to].
bool changes_known_numbers(const Candidate& candidate, const Context& context) {
  if (context.belief.known_to.empty()) return false;
  std::vector<double> typical;
  for (const auto& p : candidate.parameters) typical.push_back(p.typical);
  Edits edits;
  candidate.effect->apply(context, candidate.channel, typical, edits);
  return !edits.belief.empty() && edits.laws.empty() && edits.sensors.empty() &&
         std::ranges::all_of(edits.belief, [&](const BeliefEdit& edit) {
           return std::ranges::any_of(context.belief.known_to, [&](const KeySpread& known) {
             return known.sd > 0.0 && simulated_key(known.key) == edit.key;
           });
         });
}

}  // namespace

std::string simulated_key(const std::string& key) {
  return key == "rig.stiffness_N_per_m" ? "rig.compliance_m_per_N" : key;
}

EffectRegistration::EffectRegistration(Effect effect) { registry().push_back(std::move(effect)); }

std::vector<Effect> known_effects() {
  auto effects = registry();
  std::sort(effects.begin(), effects.end(), [](const Effect& a, const Effect& b) { return a.id < b.id; });
  return effects;
}

const BenchTest* bench_test_of(const Effect& effect, PlantKind plant) {
  for (const auto& test : effect.bench_tests)
    if (test.plants.empty() || std::ranges::find(test.plants, plant) != test.plants.end()) return &test;
  return nullptr;
}

Port port_on(PlantKind plant, Port port) {
  const bool is_axis = port == Port::joint || port == Port::body;
  return is_axis && plant == PlantKind::rotary_axis ? Port::axis : port;
}

std::string port_of(const Candidate& candidate) {
  if (!candidate.channel.empty()) return candidate.channel;
  if (candidate.effect->port != Port::sensor) return std::string(name_of(candidate.port));
  return candidate.effect->id.substr(0, candidate.effect->id.find('.'));
}

std::vector<Candidate> candidates_for(const std::vector<Effect>& effects, const Context& context) {
  std::vector<Candidate> found;
  for (const auto& effect : effects) {
    if (std::find(effect.plants.begin(), effect.plants.end(), context.plant) == effect.plants.end()) continue;
    const auto channels = effect.channels ? effect.channels(context) : std::vector<std::string>{""};
    for (const auto& channel : channels)
      if (auto parameters = effect.parameters(context, channel); !parameters.empty()) {
        found.push_back({&effect, channel, std::move(parameters), port_on(context.plant, effect.port)});
        found.back().contradicts_belief = changes_known_numbers(found.back(), context);
      }
  }
  return found;
}

}  // namespace sandhopper::diagnose
