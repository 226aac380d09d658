#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr const char* kCompliance = "robot.series_compliance_m_per_N";
constexpr const char* kDamping = "robot.series_damping_ratio";

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double believed = c.belief.value(kCompliance);
  return {{.name = "series_stiffness_N_per_m",
           .typical = 1.5e-5,
           .low = -0.9 * believed,
           .high = 2e-4,
           .base = believed,
           .reciprocal = true},
          {.name = "series_damping_ratio",
           .typical = 0.1,
           .low = -0.08,
           .high = 0.9,
           .base = c.belief.value(kDamping, 0.1)}};
}

void apply(const Context&, const std::string&, std::span<const double> v, Edits& edits) {
  edits.add(kCompliance, v[0]);
  edits.add(kDamping, v[1]);
}

bool as_keys(const Context& c, std::span<const double> v, std::map<std::string, double>& numbers) {
  numbers[kCompliance] = c.belief.value(kCompliance) + v[0];
  numbers[kDamping] = c.belief.value(kDamping, 0.1) + v[1];
  return true;
}

const EffectRegistration kEffect(
    {.id = "leg.series_elasticity",
     .port = "joint",
     .statement =
         "The leg yields along its length: a spring lies between what the encoders see and the foot.",
     .equation = "x = x_encoder - s,  F = k_s s + 2 zeta sqrt(k_s m_f) ds/dt",
     .plants = {PlantKind::hopper},
     .parameters = parameters,
     .apply = apply,
     .as_keys = as_keys});

}  // namespace
}  // namespace sandhopper::diagnose
