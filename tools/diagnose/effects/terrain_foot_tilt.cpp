#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double typical = 0.07 * c.scale("foot_radius_m", 0.04);
  return {{.name = "tilt_depth_m", .typical = typical, .low = 0.0, .high = 8.0 * typical}};
}

void apply(const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
  (void)c;
  const double depth = v[0];
  edits.law("ground.factor", [depth](const PortState& s) {
    return depth > 1e-9 ? std::min(1.0, std::max(0.0, s.position) / depth) - 1.0 : 0.0;
  });
}

const EffectRegistration kEffect(
    {.id = "terrain.foot_tilt",
     .port = "ground",
     .statement = "The foot is tilted, so that it comes to bear only over some depth.",
     .equation = "F_d -> F_d min(1, z / z_t)",
     .plants = {PlantKind::intruder, PlantKind::hopper},
     .parameters = parameters,
     .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
