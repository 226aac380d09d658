#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double typical = 0.07 * c.facts.foot_radius_m;
  // A disk of this radius, tilted by a small angle, dips in by radius x angle before its centre touches.
  return {{.name = "tilt_depth_m",
           .typical = typical,
           .low = 0.0,
           .high = 8.0 * typical,
           .other_name = "tilt_rad",
           .other_scale = 1.0 / c.facts.foot_radius_m},
          {.name = "onset_power", .typical = 1.5, .low = 0.7, .high = 4.0, .shapes = {1.0, 3.0}}};
}

void apply(const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
  (void)c;
  const double depth = v[0], power = v[1];
  edits.law(LawPort::ground_factor, [=](const GroundState& s) {
    return depth > 1e-9 ? come_in(s.depth_m, depth, power) - 1.0 : 0.0;
  });
}

const EffectRegistration kEffect(
    {.id = "terrain.foot_tilt",
     .port = Port::ground,
     .statement = "The foot is tilted, so its whole area carries only from some depth on.",
     .equation = "F_d -> F_d (1 - exp(-(z / z_t)^p))",
     .bench_tests =
         {{.kind = "press",
           .sentence =
               "Level the {foot} with a spirit level and shims and repeat a slow press: the soft first "
               "millimetres are gone only if a tilt caused them, not a false zero or a depth law."}},
     .plants = {PlantKind::intruder, PlantKind::hopper},
     .parameters = parameters,
     .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
