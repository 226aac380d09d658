#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double typical = 20.0 * std::pow(c.scale("foot_radius_m", 0.04) / 0.04, 2);
  return {{.name = "speed_law_N_s2_per_m2", .typical = typical, .low = 0.0, .high = 50.0 * typical}};
}

void apply(const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
  (void)c;
  const double factor = v[0];
  edits.law("ground.force", [factor](const PortState& s) {
    return s.accel * std::max(0.0, factor * s.velocity * s.velocity - s.load);
  });
}

const EffectRegistration kEffect(
    {.id = "terrain.depth_speed_coupling",
     .port = "ground",
     .statement = "Speed and depth do not add: the larger of a depth law and a speed law acts.",
     .equation = "F = max(F_d, c v^2)",
     .plants = {PlantKind::intruder, PlantKind::hopper},
     .parameters = parameters,
     .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
