#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double radius = c.facts.foot_radius_m;
  const double typical = 2.0 * std::pow(radius / 0.04, 2);
  return {{.name = "suction_N", .typical = typical, .low = 0.0, .high = 50.0 * typical},
          {.name = "suction_depth_m", .typical = 0.005, .low = 0.0005, .high = 0.05, .shapes = {0.02}},
          {.name = "onset_power", .typical = 1.5, .low = 0.7, .high = 4.0},
          {.name = "while_it_bears",
           .typical = 1.0,
           .low = 0.0,
           .high = 1.0,
           .shapes = {0.0},
           .is_whole_range = true}};
}

void apply(const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
  (void)c;
  const double force = v[0], depth = v[1], power = v[2], bearing = v[3];
  // `while_it_bears` = 1: suction acts from the reversal on. 0: it acts only as far as the bed no longer
  // carries the foot.
  const auto pull = [=](const GroundState& s) {
    if (s.speed_mps >= -1e-4) return 0.0;
    const double whole = force * come_in(s.depth_m, depth, power);
    const double bears = whole > 0.0 ? std::clamp(s.bearing_N / whole, 0.0, 1.0) : 0.0;
    return whole * (1.0 - (1.0 - bearing) * bears);
  };
  edits.law(LawPort::ground_force, [pull](const GroundState& s) { return -pull(s); });
  edits.law(LawPort::ground_tension, pull);
}

const EffectRegistration kEffect(
    {.id = "terrain.suction",
     .port = Port::ground,
     .statement = "The bed holds the foot back when it is withdrawn.",
     .equation = "F += -F_s (1 - exp(-(z / z_1)^p)), v < 0",
     .bench_tests =
         {{.kind = "press",
           .sentence =
               "Pull the {foot} slowly out of the bed until it hangs free: suction pulls it down until it "
               "lets go, while an offset of the load cell stays in the air and unloading cannot pull."}},
     .plants = {PlantKind::intruder, PlantKind::hopper},
     .parameters = parameters,
     .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
