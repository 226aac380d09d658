#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::string key_of(const Context& c) {
  if (c.plant == PlantKind::falling_body) return "bed.stiffness_N_per_m";
  return c.belief.value("terrain.stiffness_per_area_N_per_m3") > 0.0 ? "terrain.stiffness_per_area_N_per_m3"
                                                                     : "terrain.stiffness_N_per_m";
}

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (!has_bed(c)) return {};
  const std::string key = key_of(c);
  const double believed = c.belief.value(key, 1500.0);
  return {{.name = key.substr(key.find('.') + 1),
           .typical = 0.1,
           .low = -0.95,
           .high = 30.0,
           .either_sign = true,
           .base = believed,
           .scale = believed,
           .central_step = kStiffnessStep}};
}

void apply(const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
  edits.scale(key_of(c), 1.0 + v[0]);
}

const EffectRegistration kEffect(
    {.id = "terrain.stiffness",
     .port = Port::ground,
     .statement = "The bed is stiffer or softer than believed.",
     .equation = "F_d -> (1 + e) F_d",
     .bench_tests =
         {{.kind = "press",
           .sentence =
               "Press the {foot} slowly with the bed standing on a second scale: a stiffer bed shows in both "
               "forces, while a load cell or motor with a wrong scale disagrees with the second."}},
     .plants = {PlantKind::intruder, PlantKind::hopper, PlantKind::falling_body},
     .parameters = parameters,
     .apply = apply,
     .as_keys = [](const Context& c, std::span<const double> v, std::map<std::string, double>& numbers) {
       numbers[key_of(c)] *= 1.0 + v[0];
       return true;
     }});

}  // namespace
}  // namespace sandhopper::diagnose
