#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (!has_bed(c)) return {};
  const double typical = 3.0 * std::pow(c.scale("foot_radius_m", 0.04) / 0.04, 2);
  return {{.name = "viscous_N_s_per_m", .typical = typical, .low = 0.0, .high = 200.0 * typical}};
}

void apply(const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
  (void)c;
  const double factor = v[0];
  edits.law("ground.force", [factor](const PortState& s) { return s.accel * factor * s.velocity; });
}

const EffectRegistration kEffect({.id = "terrain.viscous",
                                  .port = "ground",
                                  .statement = "The bed resists in proportion to the intrusion speed.",
                                  .equation = "F += b v, v > 0",
                                  .plants = {PlantKind::intruder, PlantKind::hopper, PlantKind::falling_body},
                                  .parameters = parameters,
                                  .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
