#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const std::string channel = c.plant == PlantKind::hopper ? "motor_left_position_rad" : "position_rad";
  if (!c.has(channel) || range_of(c, channel) < 0.5) return {};
  return {{.name = "eccentricity_sin_rad", .typical = 0.01, .low = -0.3, .high = 0.3, .either_sign = true},
          {.name = "eccentricity_cos_rad",
           .typical = 0.01,
           .low = -0.3,
           .high = 0.3,
           .either_sign = true,
           .amplitude = true}};
}

const EffectRegistration kEffect(
    {.id = "encoder.eccentricity",
     .port = "sensor",
     .statement = "The encoder's disk or magnet is off centre: the angle's error repeats once a turn.",
     .equation = "y = theta + A sin(theta) + B cos(theta)",
     .plants = {PlantKind::rotary_axis, PlantKind::hopper},
     .parameters = parameters,
     .apply = [](const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
       const double a = v[0], b = v[1];
       const auto error = [=](const PortState& s) {
         return a * std::sin(s.position) + b * std::cos(s.position);
       };
       if (c.plant == PlantKind::rotary_axis) return edits.sensor_law("position_rad", error);
       for (const char* channel : {"motor_left_position_rad", "motor_right_position_rad"})
         edits.sensor_law(channel, error);
     }});

}  // namespace
}  // namespace sandhopper::diagnose
