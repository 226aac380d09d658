#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (!has_bed(c)) return {};
  const double typical = 3.0 * std::pow(c.facts.foot_radius_m / 0.04, 2);
  std::vector<EffectParameter> all{
      {.name = "viscous_N_s_per_m", .typical = typical, .low = 0.0, .high = 200.0 * typical}};
  add_onset(c, all);
  return all;
}

void apply(const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
  (void)c;
  const double factor = v[0], onset = onset_of(v);
  edits.law(LawPort::ground_force, [=](const GroundState& s) {
    // On the way down through its own crater the foot meets no resistance.
    const double speed = s.virgin > 0.0 ? s.speed_mps : std::min(s.speed_mps, 0.0);
    return factor * speed * come_in(s.depth_m, onset);
  });
}

const EffectRegistration kEffect(
    {.id = "terrain.viscous",
     .port = Port::ground,
     .statement = "The bed resists in proportion to the speed, into it and out of it.",
     .equation = "F += b v (1 - exp(-z / z_0)), F >= 0",
     .bench_tests =
         {{.kind = "intrusion",
           .sentence =
               "Stop the {foot} abruptly at one depth from two speeds: viscous force is gone at once and "
               "twice as much from twice the speed, while a lagging load cell creeps up to its value."}},
     .plants = {PlantKind::intruder, PlantKind::hopper, PlantKind::falling_body},
     .parameters = parameters,
     .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
