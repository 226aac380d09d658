#include "tools/diagnose/effects/axis/axis_friction.hpp"

namespace sandhopper::diagnose {
namespace {

// Radial load on the bearing of a horizontal axis, in the unit of the gravity torque G:
//   R = sqrt(G^2 + C^2 + 2 k G C cos(th)),  C = ratio J w^2
// of the weight and of the centripetal force. `ratio` is 1 for a point mass at the end of a massless arm. It
// is free because the rotor's own weight rests on the bearing, too, and no number of the belief gives it.
// k is 1 where the mass that turns hangs at the bottom at th = 0, and 0 where the two forces are at a right
// angle on average.
struct Bearing {
  Bearing(const Context& c, std::span<const double> values)
      : part(values.size() > 3 ? values[3] : 0.0),
        hanging(values.size() > 4 ? values[4] : 0.0),
        gravity_Nm(c.belief.value("axis.gravity_torque_Nm")),
        centripetal_kg_m2(values.size() > 5 ? values[5] * c.belief.value("axis.inertia_kg_m2") : 0.0),
        bottom_rad(c.belief.value("axis.bottom_rad")) {}

  double load_Nm(const AxisState& s) const {
    if (part == 0.0) return 0.0;
    const double centripetal_Nm = centripetal_kg_m2 * s.velocity_radps * s.velocity_radps;
    const double together = 2.0 * hanging * gravity_Nm * centripetal_Nm * std::cos(s.angle_rad - bottom_rad);
    return std::sqrt(std::max(0.0, gravity_Nm * gravity_Nm + centripetal_Nm * centripetal_Nm + together));
  }

  double part, hanging, gravity_Nm, centripetal_kg_m2, bottom_rad;
};

const EffectRegistration kEffect(
    {.id = "axis.load_dependent",
     .port = Port::axis,
     .statement = "Friction grows with the torque that the gear transmits, or with the load on the bearing.",
     .equation = "tau += -mu ((1 - b) (|torque| + part |G sin(th)|) + b R) sign(w), "
                 "R = sqrt(G^2 + C^2 + 2 k G C cos(th)), C = ratio J w^2",
     .plants = {PlantKind::rotary_axis},
     .parameters =
         [](const Context& c, const std::string&) {
           if (!c.facts.moves) return std::vector<EffectParameter>{};
           std::vector<EffectParameter> all{
               {.name = "load_friction_coefficient", .typical = 0.05, .low = 0.0, .high = 0.9}};
           all.push_back(own_switch_speed(c));
           if (c.belief.value("axis.gravity_torque_Nm") > 0.0) {
             all.push_back({.name = "gravity_part", .shapes = {0.0}});
             all.push_back({.name = "bearing_part", .typical = 0.5, .shapes = {0.0, 1.0}});
             all.push_back({.name = "hanging_part"});
             all.push_back({.name = "centripetal_ratio", .high = 10.0});
           }
           return all;
         },
     .apply =
         [](const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
           const double mu = v[0], switch_speed = v[1];
           const double hanging_Nm = v.size() > 2 ? v[2] * c.belief.value("axis.gravity_torque_Nm") : 0.0;
           const Bearing bearing(c, v);
           const double bottom_rad = c.belief.value("axis.bottom_rad");
           edits.law(LawPort::axis, [=](const AxisState& s) {
             const double gear_Nm =
                 std::abs(s.torque_Nm) + hanging_Nm * std::abs(std::sin(s.angle_rad - bottom_rad));
             const double load_Nm = (1.0 - bearing.part) * gear_Nm + bearing.part * bearing.load_Nm(s);
             return -mu * load_Nm * sign_smooth(s.velocity_radps, switch_speed);
           });
         }});

}  // namespace
}  // namespace sandhopper::diagnose
