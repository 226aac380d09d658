#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double believed = c.belief.value("robot.rail_viscous_N_s_per_m", 0.0);
  return {{.name = "rail_viscous_N_s_per_m",
           .typical = 1.0,
           .low = -believed,
           .high = 50.0,
           .either_sign = true,
           .base = believed}};
}

const EffectRegistration kEffect(
    {.id = "rail.viscous",
     .port = Port::rail,
     .statement = "Friction proportional to speed acts between body and rail.",
     .equation = "F += -b z'",
     .bench_tests = {{.sentence = "Pull the unpowered body along the rail by a force gauge at three steady "
                                  "speeds: viscous friction adds force in proportion to speed; dry friction, "
                                  "the cable and the still joints do not."}},
     .plants = {PlantKind::hopper},
     .parameters = parameters,
     .apply = [](const Context&, const std::string&, std::span<const double> v,
                 Edits& edits) { edits.add("robot.rail_viscous_N_s_per_m", v[0]); },
     .belief_key = "robot.rail_viscous_N_s_per_m"});

}  // namespace
}  // namespace sandhopper::diagnose
