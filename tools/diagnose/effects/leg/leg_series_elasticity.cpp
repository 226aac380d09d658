#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr BelievedNumber kCompliance{"robot.series_compliance_m_per_N"};
constexpr BelievedNumber kDamping{"robot.series_damping_ratio", 0.1};

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double believed = kCompliance.of(c);
  return {
      {.name = "series_stiffness_N_per_m",
       .typical = 1.5e-5,
       .low = -0.9 * believed,
       .high = 2e-4,
       .base = believed,
       .power = -1.0},
      {.name = "series_damping_ratio", .typical = 0.1, .low = -0.08, .high = 0.9, .base = kDamping.of(c)}};
}

const EffectRegistration kEffect(adds_to(
    {kCompliance, kDamping},
    {.id = "leg.series_elasticity",
     .port = Port::joint,
     .statement =
         "The leg yields along its length: a spring lies between what the encoders see and the foot.",
     .equation = "x = x_encoder - s,  F = k_s s + 2 zeta sqrt(k_s m_f) ds/dt",
     .bench_tests = {{.kind = "clamped",
                      .sentence = "Clamp the body with the foot on a rigid block and raise the torque in "
                                  "steps: the encoders move in proportion to the force only if the leg "
                                  "yields; play moves them once, and there is no bed."}},
     .plants = {PlantKind::hopper},
     .parameters = parameters}));

}  // namespace
}  // namespace sandhopper::diagnose
