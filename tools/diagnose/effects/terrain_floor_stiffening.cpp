#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double radius = c.scale("foot_radius_m", 0.04);
  return {{.name = "stiffening_at_deepest", .typical = 0.2, .low = 0.0, .high = 10.0},
          {.name = "stiffening_length_m",
           .typical = 0.3 * radius,
           .low = 0.03 * radius,
           .high = 2.0 * radius,
           .shapes = {0.12 * radius, 0.7 * radius}}};
}

void apply(const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
  const double amount = v[0], length = v[1], deepest = c.scale("depth_m", 0.04);
  edits.law("ground.factor",
            [=](const PortState& s) { return amount * std::exp((s.position - deepest) / length); });
}

const EffectRegistration kEffect(
    {.id = "terrain.floor_stiffening",
     .port = "ground",
     .statement = "Near the floor of the container the bed stiffens exponentially.",
     .equation = "F_d -> F_d (1 + A exp((z - z_max) / l))",
     .plants = {PlantKind::intruder, PlantKind::hopper},
     .parameters = parameters,
     .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
