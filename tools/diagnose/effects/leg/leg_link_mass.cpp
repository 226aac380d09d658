#include "estimation/leg.hpp"
#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr BelievedNumber kLower{"robot.lower_link_mass_kg", LegParameters{}.lower_link_mass_kg};
constexpr BelievedNumber kUpper{"robot.upper_link_mass_kg", LegParameters{}.upper_link_mass_kg};

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const auto link = [&](const char* name, double believed) {
    return EffectParameter{.name = name,
                           .typical = 0.03,
                           .low = -0.9 * believed,
                           .high = 1.0,
                           .either_sign = true,
                           .base = believed,
                           .amplitude = true};
  };
  return {link("lower_link_mass_kg", kLower.of(c)), link("upper_link_mass_kg", kUpper.of(c))};
}

const EffectRegistration kEffect(adds_to(
    {kLower, kUpper},
    {.id = "leg.link_mass",
     .port = Port::inertia,
     .statement = "The leg's links are heavier or lighter than believed.",
     .equation = "m_2 -> m_2 + dm_2, m_1 -> m_1 + dm_1 (lower, upper link)",
     .bench_tests = {{.sentence = "Weigh the links on a balance, each by itself: a wrong mass shows there; "
                                  "foot, rotors, joints and accelerometers have no effect."}},
     .plants = {PlantKind::hopper},
     .parameters = parameters}));

}  // namespace
}  // namespace sandhopper::diagnose
