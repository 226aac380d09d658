#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

// Shares of the depth by which the rig yields where its signature is taken: it is not linear in the
// compliance.
constexpr double kSmallYield = 0.05, kLargeYield = 0.2;

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double stiffness = c.belief.value("rig.stiffness_N_per_m");
  const double yield = c.facts.depth_m / c.facts.force_N;  // the rig yields by the whole depth
  return {{.name = "stiffness_N_per_m",
           .typical = 1e-5,
           .low = stiffness > 0.0 ? -0.9 / stiffness : 0.0,
           .high = 1e-3,
           .base = stiffness > 0.0 ? 1.0 / stiffness : 0.0,
           .power = -1.0,
           .shapes = {kSmallYield * yield, kLargeYield * yield}}};
}

void apply(const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
  (void)c;
  edits.add("rig.compliance_m_per_N", v[0]);
}

const EffectRegistration kEffect(
    {.id = "rig.compliance",
     .port = Port::geometry,
     .statement = "The rig yields under the force: the foot is less deep than the encoder says.",
     .equation = "z = z_recorded - F / k_r",
     .bench_tests = {{.kind = "clamped",
                      .sentence =
                          "Press the plate on a rigid block: the recorded position changes with the force "
                          "only if the rig yields; bed and surface have no effect."}},
     .plants = {PlantKind::intruder},
     .parameters = parameters,
     .apply = apply,
     .belief_key = "rig.stiffness_N_per_m"});

}  // namespace
}  // namespace sandhopper::diagnose
