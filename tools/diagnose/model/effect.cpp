#include "tools/diagnose/model/effect.hpp"

#include <algorithm>

namespace sandhopper::diagnose {
namespace {

std::vector<Effect>& registry() {
  static std::vector<Effect> effects;
  return effects;
}

}  // namespace

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
      if (auto parameters = effect.parameters(context, channel); !parameters.empty())
        found.push_back({&effect, channel, std::move(parameters), port_on(context.plant, effect.port)});
  }
  return found;
}

}  // namespace sandhopper::diagnose
