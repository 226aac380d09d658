#include "tools/diagnose/effects/common.hpp"
#include "tools/diagnose/plants/falling_body/falling_simulation.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr double kShareOfWeight = 0.1;

// If density and frontal area are known, fit the dimensionless drag coefficient; otherwise the whole factor.
bool medium_known(const Context& c) {
  return c.plant == PlantKind::falling_body && c.belief.value("medium.density_kg_per_m3") > 0.0 &&
         c.belief.value("body.frontal_area_m2") > 0.0;
}

// Drag factor whose force is this fraction of the weight at the largest speed.
double noticeable_N_s2_per_m2(const Context& c) {
  return kShareOfWeight * c.facts.weight_N / std::pow(c.facts.speed_mps, 2);
}

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (c.plant == PlantKind::rotary_axis) {
    if (!c.facts.moves) return {};
    const double typical = kShareOfWeight * c.facts.torque_Nm / std::pow(c.facts.speed_radps, 2);
    return {{.name = "quadratic_drag_Nm_s2", .typical = typical, .low = 0.0, .high = 200.0 * typical}};
  }
  if (medium_known(c)) {
    const double believed = c.belief.value("medium.drag_coefficient");
    const double per_coefficient_N_s2_per_m2 =
        0.5 * c.belief.value("medium.density_kg_per_m3") * c.belief.value("body.frontal_area_m2");
    // Allow several times the largest plausible coefficient, because it may stand for another force.
    const double typical = std::max(0.5, noticeable_N_s2_per_m2(c) / per_coefficient_N_s2_per_m2);
    return {{.name = "drag_coefficient",
             .typical = typical,
             .low = -believed,
             .high = std::max(20.0, 10.0 * typical),
             .base = believed}};
  }
  const double typical = noticeable_N_s2_per_m2(c);
  return {{.name = "quadratic_drag_N_s2_per_m2", .typical = typical, .low = 0.0, .high = 200.0 * typical}};
}

void apply(const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
  if (medium_known(c)) return edits.add("medium.drag_coefficient", v[0]);
  const double factor = v[0];
  if (c.plant == PlantKind::rotary_axis)
    return edits.law(LawPort::axis, [=](const AxisState& s) {
      return -factor * std::abs(s.velocity_radps) * s.velocity_radps;
    });
  const double length = front_m(c.facts.wetted_over_m);
  edits.law(LawPort::body, [=](const BodyState& s) {
    return -factor * wetted_share(s.depth_m, length) * std::abs(s.velocity_mps) * s.velocity_mps;
  });
}

const EffectRegistration kEffect(
    {.id = "air.quadratic_drag",
     .port = Port::body,
     .statement = "The medium resists with a force that grows with the square of speed.",
     .equation = "F += -1/2 rho A C_d |v| v, tau += -c |w| w",
     .bench_tests =
         {{.sentence =
               "Tow the body by a force gauge through the medium at a steady speed and at twice of it: "
               "quadratic drag grows fourfold, linear drag doubles, and mass and added mass add nothing.",
           .plants = {PlantKind::falling_body}},
          {.kind = "motion",
           .sentence = "Repeat a fast motion with a light card on the arm that doubles its area: drag of the "
                       "air grows with the area, and friction in the bearings does not.",
           .plants = {PlantKind::rotary_axis}}},
     .plants = {PlantKind::falling_body, PlantKind::rotary_axis},
     .parameters = parameters,
     .apply = apply,
     .belief_key = "medium.drag_coefficient"});

}  // namespace
}  // namespace sandhopper::diagnose
