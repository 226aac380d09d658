#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (c.scale("moves") == 0.0) return {};
  const double torque = 0.1 * c.scale("torque_Nm");
  const double speed = 0.05 * c.scale("speed_radps");
  return {{.name = "stribeck_torque_Nm", .typical = torque, .low = 0.0, .high = 50.0 * torque},
          {.name = "stribeck_speed_radps",
           .typical = speed,
           .low = 0.2 * speed,
           .high = 8.0 * speed,
           .shapes = {0.4 * speed, 2.5 * speed}}};
}

const EffectRegistration kEffect(
    {.id = "axis.stribeck",
     .port = "axis",
     .statement = "Near standstill dry friction is larger than in motion (Stribeck).",
     .equation = "tau += -dF exp(-(w/w_s)^2) sign(w)",
     .plants = {PlantKind::rotary_axis},
     .parameters = parameters,
     .apply = [](const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
       const double torque = v[0], speed = v[1];
       const double switch_speed = c.belief.value("axis.friction_switch_speed_radps", 0.02);
       edits.law("axis", [=](const PortState& s) {
         const double u = s.velocity / speed;
         return -torque * std::exp(-u * u) * sign_smooth(s.velocity, switch_speed);
       });
     }});

}  // namespace
}  // namespace sandhopper::diagnose
