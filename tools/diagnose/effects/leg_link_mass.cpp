#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect({.id = "leg.link_mass",
                                  .port = "inertia",
                                  .statement = "The leg's links are heavier or lighter than believed.",
                                  .equation = "m_1, m_2 -> (1 + e) m_1, (1 + e) m_2",
                                  .plants = {PlantKind::hopper},
                                  .parameters =
                                      [](const Context&, const std::string&) {
                                        return std::vector<EffectParameter>{{.name = "link_mass_relative",
                                                                             .typical = 0.3,
                                                                             .low = -0.9,
                                                                             .high = 20.0,
                                                                             .either_sign = true}};
                                      },
                                  .apply =
                                      [](const Context&, const std::string&, std::span<const double> v,
                                         Edits& edits) {
                                        edits.scale("robot.upper_link_mass_kg", 1.0 + v[0]);
                                        edits.scale("robot.lower_link_mass_kg", 1.0 + v[0]);
                                      }});

}  // namespace
}  // namespace sandhopper::diagnose
