#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (c.scale("moves") == 0.0) return {};
  const double believed = c.belief.value("axis.coulomb_friction_Nm", 0.0);
  const double typical = 0.1 * c.scale("torque_Nm");
  return {{.name = "coulomb_friction_Nm",
           .typical = typical,
           .low = -believed,
           .high = 100.0 * typical,
           .either_sign = false,
           .base = believed}};
}

const EffectRegistration kEffect({.id = "axis.coulomb",
                                  .port = "axis",
                                  .statement = "Dry friction of constant size opposes the axis.",
                                  .equation = "tau += -c sign(w)",
                                  .plants = {PlantKind::rotary_axis},
                                  .parameters = parameters,
                                  .apply = [](const Context&, const std::string&, std::span<const double> v,
                                              Edits& edits) { edits.add("axis.coulomb_friction_Nm", v[0]); },
                                  .belief_key = "axis.coulomb_friction_Nm"});

}  // namespace
}  // namespace sandhopper::diagnose
