#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double typical = 2.0 * std::pow(c.facts.foot_radius_m / 0.04, 2);
  return {{.name = "crust_force_N", .typical = typical, .low = 0.0, .high = 50.0 * typical},
          {.name = "crust_depth_m", .typical = 0.002, .low = 0.0002, .high = 0.02, .shapes = {0.005}},
          {.name = "left_after_a_push",
           .typical = 0.5,
           .low = 0.0,
           .high = 1.0,
           .shapes = {0.0, 1.0},
           .is_whole_range = true},
          part_of_unloading()};
}

void apply(const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
  (void)c;
  const double force = v[0], depth = v[1], left = v[2], unloads = v[3];
  const auto crust_N = [=](const GroundState& s) {
    return (s.pushes > 0.0 ? left : 1.0) * force * come_in(s.depth_m, depth);
  };
  // `part_of_unloading`: fraction of the crust's force that remains until unloading starts.
  edits.law(LawPort::ground_static, [=](const GroundState& s) { return unloads * crust_N(s); });
  edits.law(LawPort::ground_force,
            [=](const GroundState& s) { return s.virgin * (1.0 - unloads) * crust_N(s); });
}

const EffectRegistration kEffect(
    {.id = "terrain.crust",
     .port = Port::ground,
     .statement =
         "A cohesive crust resists from the first millimetres on, whatever the depth, until it is broken.",
     .equation = "F += F_c (1 - exp(-z / z_c))",
     .bench_tests =
         {{.kind = "press",
           .sentence =
               "Press the {foot} slowly into an untouched bed, and again where the top millimetres were "
               "raked loose: the force of a crust is gone, while a false zero or a depth law stays."}},
     .plants = {PlantKind::intruder, PlantKind::hopper},
     .parameters = parameters,
     .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
