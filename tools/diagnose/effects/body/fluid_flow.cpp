#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr const char* kKey = "medium.upward_mps";

// Only for bodies that rise and fall. In falls alone a flow acts like linear drag: to first order the drag
// k (v - w)^2 changes by -2 k w v. On the way up it has the other sign.
std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const bool has_drag =
      (c.belief.value("medium.density_kg_per_m3") > 0.0 && c.belief.value("medium.drag_coefficient") > 0.0) ||
      c.belief.value("medium.linear_drag_N_s_per_m") > 0.0;
  if (!has_drag || !c.facts.rises_and_falls) return {};
  const double typical = 0.05 * c.facts.speed_mps, fastest = c.facts.speed_mps;
  return {{.name = "medium_upward_mps",
           .typical = typical,
           .low = -fastest,
           .high = fastest,
           .either_sign = true,
           .base = c.belief.value(kKey)}};
}

void apply(const Context&, const std::string&, std::span<const double> v, Edits& edits) {
  edits.add(kKey, v[0]);
}

const EffectRegistration kEffect(
    {.id = "fluid.flow",
     .port = Port::body,
     .statement = "The medium moves up or down at a steady speed, as air in a draught does.",
     .equation = "v -> v - w in every drag, w upward",
     .bench_tests = {{.sentence =
                          "Hold a light thread or a drop of dye where the bodies fall: it shows a flow "
                          "of the medium, and no fault of a sensor or of the drag does."}},
     .plants = {PlantKind::falling_body},
     .parameters = parameters,
     .apply = apply,
     .belief_key = kKey});

}  // namespace
}  // namespace sandhopper::diagnose
