#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (!has_bed(c)) return {};
  const double typical = 5.0 * std::pow(c.facts.foot_radius_m / 0.04, 2);
  std::vector<EffectParameter> all{
      {.name = "quadratic_drag_N_s2_per_m2", .typical = typical, .low = 0.0, .high = 100.0 * typical}};
  add_onset(c, all);
  return all;
}

void apply(const Context&, const std::string&, std::span<const double> v, Edits& edits) {
  const double factor = v[0], onset = onset_of(v);
  edits.law(LawPort::ground_force, [=](const GroundState& s) {
    return s.virgin * factor * s.speed_mps * s.speed_mps * come_in(s.depth_m, onset);
  });
}

const EffectRegistration kEffect(
    {.id = "terrain.quadratic_drag",
     .port = Port::ground,
     .statement = "The bed resists with the square of the intrusion speed.",
     .equation = "F += c v^2 (1 - exp(-z / z_0)), v > 0",
     .bench_tests =
         {{.kind = "intrusion",
           .sentence =
               "Push the {foot} at a steady speed and at twice of it to several of its widths: the force "
               "that speed adds grows fourfold with drag, also down there, where added mass grows no more."}},
     .plants = {PlantKind::intruder, PlantKind::hopper, PlantKind::falling_body},
     .parameters = parameters,
     .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
