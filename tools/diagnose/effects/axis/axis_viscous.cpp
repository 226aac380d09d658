#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (!c.facts.moves) return {};
  const double believed = c.belief.value("axis.viscous_friction_Nm_s", 0.0);
  const double typical = 0.1 * c.facts.torque_Nm / c.facts.speed_radps;
  return {{.name = "viscous_friction_Nm_s",
           .typical = typical,
           .low = -believed,
           .high = 100.0 * typical,
           .either_sign = false,
           .base = believed}};
}

const EffectRegistration kEffect(
    {.id = "axis.viscous",
     .port = Port::axis,
     .statement = "Friction proportional to speed opposes the axis.",
     .equation = "tau += -b w",
     .bench_tests =
         {{.sentence =
               "Turn the axis by a torque gauge with the drive off at three steady speeds: viscous friction "
               "adds torque in proportion to speed, dry friction none, and drag of the air its square."}},
     .plants = {PlantKind::rotary_axis},
     .parameters = parameters,
     .apply = [](const Context&, const std::string&, std::span<const double> v,
                 Edits& edits) { edits.add("axis.viscous_friction_Nm_s", v[0]); },
     .belief_key = "axis.viscous_friction_Nm_s"});

}  // namespace
}  // namespace sandhopper::diagnose
