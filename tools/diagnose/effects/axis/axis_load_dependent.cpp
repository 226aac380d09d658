#include "tools/diagnose/effects/axis/axis_friction.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(
    {.id = "axis.load_dependent",
     .port = Port::axis,
     .statement = "Friction grows with the torque the gear carries and the load its bearing does.",
     .equation = "tau += -mu (|torque| + part |G sin(th)|) sign(w)",
     .bench_tests = {{.kind = "motion",
                      .sentence =
                          "Repeat a slow motion up and down with a weight on the arm: the torques up and "
                          "down move apart under the weight only if friction grows with the load."}},
     .plants = {PlantKind::rotary_axis},
     .parameters =
         [](const Context& c, const std::string&) {
           if (!c.facts.moves) return std::vector<EffectParameter>{};
           std::vector<EffectParameter> all{
               {.name = "load_friction_coefficient", .typical = 0.05, .low = 0.0, .high = 0.9}};
           all.push_back(own_switch_speed(c));
           if (c.belief.value("axis.gravity_torque_Nm") > 0.0)
             all.push_back({.name = "gravity_part", .shapes = {0.0}, .is_whole_range = true});
           return all;
         },
     .apply =
         [](const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
           const double mu = v[0], switch_speed = v[1];
           const double hanging_Nm = v.size() > 2 ? v[2] * c.belief.value("axis.gravity_torque_Nm") : 0.0;
           const double bottom_rad = c.belief.value("axis.bottom_rad");
           edits.law(LawPort::axis, [=](const AxisState& s) {
             const double load_Nm =
                 std::abs(s.torque_Nm) + hanging_Nm * std::abs(std::sin(s.angle_rad - bottom_rad));
             return -mu * load_Nm * sign_smooth(s.velocity_radps, switch_speed);
           });
         }});

}  // namespace
}  // namespace sandhopper::diagnose
