#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (!has_bed(c)) return {};
  const double typical = 5.0 * std::pow(c.scale("foot_radius_m", 0.04) / 0.04, 2);
  std::vector<EffectParameter> all{
      {.name = "quadratic_drag_N_s2_per_m2", .typical = typical, .low = 0.0, .high = 100.0 * typical}};
  // Over which depth it comes in shows where the motion is prescribed and recorded.
  if (c.plant == PlantKind::intruder)
    all.push_back({.name = "onset_depth_m", .typical = 1e-3, .low = 1e-5, .high = 0.01, .shapes = {3e-3}});
  return all;
}

void apply(const Context&, const std::string&, std::span<const double> v, Edits& edits) {
  const double factor = v[0], onset = v.size() > 1 ? v[1] : 1e-5;
  edits.law("ground.force", [=](const PortState& s) {
    return s.accel * factor * s.velocity * s.velocity * (1.0 - std::exp(-s.position / onset));
  });
}

const EffectRegistration kEffect({.id = "terrain.quadratic_drag",
                                  .port = "ground",
                                  .statement = "The bed resists with the square of the intrusion speed.",
                                  .equation = "F += c v^2 (1 - exp(-z / z_0)), v > 0",
                                  .plants = {PlantKind::intruder, PlantKind::hopper, PlantKind::falling_body},
                                  .parameters = parameters,
                                  .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
