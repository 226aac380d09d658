#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (!has_bed(c)) return {};
  const double typical = 3.0 * std::pow(c.scale("foot_radius_m", 0.04) / 0.04, 2);
  std::vector<EffectParameter> all{
      {.name = "viscous_N_s_per_m", .typical = typical, .low = 0.0, .high = 200.0 * typical}};
  add_onset(c, all);
  return all;
}

void apply(const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
  (void)c;
  const double factor = v[0], onset = onset_of(v);
  edits.law("ground.force", [=](const PortState& s) {
    // Going down through its own crater the foot meets nothing.
    const double speed = s.accel > 0.0 ? s.velocity : std::min(s.velocity, 0.0);
    return factor * speed * come_in(s.position, onset);
  });
}

const EffectRegistration kEffect(
    {.id = "terrain.viscous",
     .port = "ground",
     .statement = "The bed resists in proportion to the speed, into it and out of it.",
     .equation = "F += b v (1 - exp(-z / z_0)), F >= 0",
     .plants = {PlantKind::intruder, PlantKind::hopper, PlantKind::falling_body},
     .parameters = parameters,
     .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
