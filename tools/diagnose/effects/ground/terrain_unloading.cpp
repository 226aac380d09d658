#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double believed = c.belief.value("terrain.unloading_stiffness_ratio", 30.0);
  return {{.name = "unloading_stiffness_ratio",
           .typical = 0.5 * believed,
           .low = 1.0 - believed,
           .high = 10.0 * believed,
           .either_sign = true,
           .base = believed,
           .shapes = {-0.65 * believed}}};
}

void apply(const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
  (void)c;
  edits.add("terrain.unloading_stiffness_ratio", v[0]);
}

const EffectRegistration kEffect(
    {.id = "terrain.unloading",
     .port = Port::ground,
     .statement = "When the foot moves up, the force of the bed falls along another line than believed.",
     .equation = "F = F_max - r k (z_max - z)",
     .bench_tests = {{.kind = "press",
                      .sentence = "Press slowly and draw back by a fraction of a millimetre at several "
                                  "depths: the slope of these small loops is unloading; suction only shifts "
                                  "them, and drag and added mass need speed.",
                      .same_for = {"rig.compliance", "leg.series_elasticity"}}},
     .plants = {PlantKind::intruder, PlantKind::hopper},
     .parameters = parameters,
     .apply = apply,
     .belief_key = "terrain.unloading_stiffness_ratio"});

}  // namespace
}  // namespace sandhopper::diagnose
