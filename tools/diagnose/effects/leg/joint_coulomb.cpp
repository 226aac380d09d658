#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double believed = c.belief.value("robot.joint_coulomb_Nm", 0.015);
  return {{.name = "joint_coulomb_Nm",
           .typical = 0.03,
           .low = -believed,
           .high = 1.0,
           .either_sign = true,
           .base = believed}};
}

const EffectRegistration kEffect(
    {.id = "joint.coulomb",
     .port = Port::joint,
     .statement = "Dry friction of constant size acts in the joints.",
     .equation = "tau += -tau_c sign(w)",
     .bench_tests =
         {{.kind = "air_sweep",
           .sentence =
               "Sweep the foot slowly in the air with the body clamped, and at twice the speed: dry friction "
               "of the joints turns with the direction and keeps its size, and the rail does not move."}},
     .plants = {PlantKind::hopper},
     .parameters = parameters,
     .apply = [](const Context&, const std::string&, std::span<const double> v,
                 Edits& edits) { edits.add("robot.joint_coulomb_Nm", v[0]); },
     .belief_key = "robot.joint_coulomb_Nm"});

}  // namespace
}  // namespace sandhopper::diagnose
