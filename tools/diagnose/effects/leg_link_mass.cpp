#include "estimation/leg.hpp"
#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr const char* kLower = "robot.lower_link_mass_kg";
constexpr const char* kUpper = "robot.upper_link_mass_kg";

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
  const LegParameters leg;
  return {link("lower_link_mass_kg", c.belief.value(kLower, leg.lower_link_mass_kg)),
          link("upper_link_mass_kg", c.belief.value(kUpper, leg.upper_link_mass_kg))};
}

const EffectRegistration kEffect(
    {.id = "leg.link_mass",
     .port = "inertia",
     .statement = "The leg's links are heavier or lighter than believed.",
     .equation = "m_2 -> m_2 + dm_2, m_1 -> m_1 + dm_1 (lower, upper link)",
     .plants = {PlantKind::hopper},
     .parameters = parameters,
     .apply =
         [](const Context&, const std::string&, std::span<const double> v, Edits& edits) {
           edits.add(kLower, v[0]);
           edits.add(kUpper, v[1]);
         },
     .as_keys =
         [](const Context& c, std::span<const double> v, std::map<std::string, double>& numbers) {
           const auto now = parameters(c, "");
           numbers[kLower] = now[0].reported(v[0]);
           numbers[kUpper] = now[1].reported(v[1]);
           return true;
         }});

}  // namespace
}  // namespace sandhopper::diagnose
