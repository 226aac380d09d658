#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

// Of bearings and gears; what fades over several rad/s is no boundary lubrication.
constexpr double kFastest_radps = 1.5;

double switch_speed_radps(const Context& c) {
  return c.belief.value("axis.friction_switch_speed_radps", 0.02);
}

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (c.scale("moves") == 0.0) return {};
  const double torque = 0.1 * c.scale("torque_Nm");
  // Below its switch speed all dry friction fades through zero: nothing slower can be told apart.
  const double slowest = 2.0 * switch_speed_radps(c), fastest = std::max(kFastest_radps, 4.0 * slowest);
  const double speed = std::clamp(0.05 * c.scale("speed_radps"), 1.5 * slowest, 0.5 * fastest);
  return {{.name = "stribeck_torque_Nm", .typical = torque, .low = 0.0, .high = 50.0 * torque},
          {.name = "stribeck_speed_radps",
           .typical = speed,
           .low = slowest,
           .high = fastest,
           .other_law_above = true,
           .shapes = {slowest, 0.8 * fastest}}};
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
       const double switch_speed = switch_speed_radps(c);
       edits.law("axis", [=](const PortState& s) {
         const double u = s.velocity / speed;
         return -torque * std::exp(-u * u) * sign_smooth(s.velocity, switch_speed);
       });
     }});

}  // namespace
}  // namespace sandhopper::diagnose
