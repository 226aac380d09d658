#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(
    {.id = "axis.load_dependent",
     .port = "axis",
     .statement = "Friction grows with the torque the gear carries.",
     .equation = "tau += -mu |torque| sign(w)",
     .plants = {PlantKind::rotary_axis},
     .parameters =
         [](const Context& c, const std::string&) {
           if (c.scale("moves") == 0.0) return std::vector<EffectParameter>{};
           return std::vector<EffectParameter>{
               {.name = "load_friction_coefficient", .typical = 0.05, .low = 0.0, .high = 0.9}};
         },
     .apply =
         [](const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
           const double mu = v[0];
           const double switch_speed = c.belief.value("axis.friction_switch_speed_radps", 0.02);
           edits.law("axis", [=](const PortState& s) {
             return -mu * std::abs(s.load) * sign_smooth(s.velocity, switch_speed);
           });
         }});

}  // namespace
}  // namespace sandhopper::diagnose
