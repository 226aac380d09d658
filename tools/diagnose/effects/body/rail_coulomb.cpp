#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double believed = c.belief.value("robot.rail_coulomb_N", 4.0);
  return {{.name = "rail_coulomb_N",
           .typical = 1.0,
           .low = -believed,
           .high = 50.0,
           .either_sign = true,
           .base = believed}};
}

const EffectRegistration kEffect(
    {.id = "rail.coulomb",
     .port = Port::rail,
     .statement = "Dry friction of constant size acts between body and rail.",
     .equation = "F += -F_c sign(z')",
     .bench_tests =
         {{.sentence =
               "Pull the unpowered body slowly up and down the rail by a force gauge: half the difference of "
               "the forces is friction; it is dry if twice the speed does not change it."}},
     .plants = {PlantKind::hopper},
     .parameters = parameters,
     .apply = [](const Context&, const std::string&, std::span<const double> v,
                 Edits& edits) { edits.add("robot.rail_coulomb_N", v[0]); },
     .belief_key = "robot.rail_coulomb_N"});

}  // namespace
}  // namespace sandhopper::diagnose
