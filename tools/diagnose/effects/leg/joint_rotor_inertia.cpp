#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double believed = c.belief.value("robot.rotor_inertia_kg_m2", 2e-4);
  return {{.name = "rotor_inertia_kg_m2",
           .typical = 1e-4,
           .low = -0.9 * believed,
           .high = 5e-3,
           .either_sign = true,
           .base = believed}};
}

const EffectRegistration kEffect(
    {.id = "joint.rotor_inertia",
     .port = Port::inertia,
     .statement = "The rotors' inertia is not the believed one.",
     .equation = "J -> J + dJ",
     .bench_tests =
         {{.sentence =
               "Take the links off and turn the bare rotors, without and with a disk of known inertia: the "
               "two accelerations give the rotor inertia; foot, links, gravity and bed have no effect."}},
     .plants = {PlantKind::hopper},
     .parameters = parameters,
     .apply = [](const Context&, const std::string&, std::span<const double> v,
                 Edits& edits) { edits.add("robot.rotor_inertia_kg_m2", v[0]); },
     .belief_key = "robot.rotor_inertia_kg_m2"});

}  // namespace
}  // namespace sandhopper::diagnose
