#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (!c.facts.moves) return {};
  const double believed = c.belief.value("axis.inertia_kg_m2", 1.0);
  const double typical = 0.1 * believed;
  return {{.name = "inertia_kg_m2",
           .typical = typical,
           .low = -0.9 * believed,
           .high = 10.0 * believed,
           .either_sign = true,
           .base = believed,
           .other_name = "inertia_change_fraction",
           .other_scale = 1.0 / believed}};
}

const EffectRegistration kEffect(
    {.id = "axis.inertia",
     .port = Port::inertia,
     .statement = "The inertia of the axis is not the believed one.",
     .equation = "J -> J + dJ",
     .bench_tests =
         {{.kind = "motion",
           .sentence =
               "Repeat one motion with a disk of known inertia bolted to the axis: how far that slows the "
               "axis gives its own inertia, whatever the scale of the torque, gravity and friction."}},
     .plants = {PlantKind::rotary_axis},
     .parameters = parameters,
     .apply = [](const Context&, const std::string&, std::span<const double> v,
                 Edits& edits) { edits.add("axis.inertia_kg_m2", v[0]); },
     .belief_key = "axis.inertia_kg_m2"});

}  // namespace
}  // namespace sandhopper::diagnose
