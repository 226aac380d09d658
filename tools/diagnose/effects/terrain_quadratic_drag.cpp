#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (!has_bed(c)) return {};
  const double typical = 5.0 * std::pow(c.scale("foot_radius_m", 0.04) / 0.04, 2);
  return {{.name = "quadratic_drag_N_s2_per_m2", .typical = typical, .low = 0.0, .high = 100.0 * typical}};
}

void apply(const Context&, const std::string&, std::span<const double> v, Edits& edits) {
  const double factor = v[0];
  edits.law("ground.force",
            [factor](const PortState& s) { return s.accel * factor * s.velocity * s.velocity; });
}

const EffectRegistration kEffect({.id = "terrain.quadratic_drag",
                                  .port = "ground",
                                  .statement = "The bed resists with the square of the intrusion speed.",
                                  .equation = "F += c v^2, v > 0",
                                  .plants = {PlantKind::intruder, PlantKind::hopper, PlantKind::falling_body},
                                  .parameters = parameters,
                                  .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
