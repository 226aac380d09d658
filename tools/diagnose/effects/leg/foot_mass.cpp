#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double believed = c.belief.value("robot.foot_mass_kg", 0.55);
  return {{.name = "foot_mass_kg",
           .typical = 0.04,
           .low = -0.9 * believed,
           .high = 5.0,
           .either_sign = true,
           .base = believed}};
}

const EffectRegistration kEffect(
    {.id = "foot.mass",
     .port = Port::inertia,
     .statement = "The foot's mass is not the believed one.",
     .equation = "m_f -> m_f + dm",
     .bench_tests =
         {{.sentence = "Weigh the foot on a balance, apart from the links: a wrong mass shows there; rotor "
                       "inertia, added mass of the bed and the load cell have no effect."}},
     .plants = {PlantKind::hopper},
     .parameters = parameters,
     .apply = [](const Context&, const std::string&, std::span<const double> v,
                 Edits& edits) { edits.add("robot.foot_mass_kg", v[0]); },
     .belief_key = "robot.foot_mass_kg"});

}  // namespace
}  // namespace sandhopper::diagnose
