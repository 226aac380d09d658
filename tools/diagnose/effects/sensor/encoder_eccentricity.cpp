#include "tools/diagnose/effects/common.hpp"
#include "tools/diagnose/model/virtual_channels.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const std::string channel = c.plant == PlantKind::hopper ? "motor_left_position_rad" : "position_rad";
  if (!c.has(channel) || range_of(c, channel) < 0.5) return {};
  std::vector<EffectParameter> all{{.name = "eccentricity_sin_rad",
                                    .typical = 0.01,
                                    .low = -0.3,
                                    .high = 0.3,
                                    .either_sign = true,
                                    .amplitude_name = "eccentricity_rad"},
                                   {.name = "eccentricity_cos_rad",
                                    .typical = 0.01,
                                    .low = -0.3,
                                    .high = 0.3,
                                    .either_sign = true,
                                    .amplitude = true}};
  // The velocity channel is the derivative of this encoder (1) or comes from another sensor (0).
  if (c.plant == PlantKind::rotary_axis && c.has("velocity_radps"))
    all.push_back({.name = "part_of_velocity", .shapes = {0.0}, .is_whole_range = true});
  return all;
}

const EffectRegistration kEffect(
    {.id = "encoder.eccentricity",
     .port = Port::sensor,
     .statement = "The encoder's disk or magnet is off centre: the angle's error repeats once a turn.",
     .equation = "y = theta + A sin(theta) + B cos(theta); of the velocity its derivative, in part",
     .bench_tests =
         {{.kind = "hold",
           .sentence =
               "Set the shaft to known angles all round a turn, at rest, and read the encoder: an error that "
               "repeats once a turn is eccentricity, a constant one an offset; torques have no effect."}},
     .plants = {PlantKind::rotary_axis, PlantKind::hopper},
     .parameters = parameters,
     .apply = [](const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
       const double a = v[0], b = v[1];
       const auto error = [=](const SensorState& s) { return a * std::sin(s.value) + b * std::cos(s.value); };
       if (c.plant == PlantKind::rotary_axis) {
         edits.sensor_law("position_rad", error);
         if (v.size() > 2)
           edits.sensor_law(kVelocityOfAngle, [a = v[2] * a, b = v[2] * b](const AxisState& s) {
             return s.velocity_radps * (a * std::cos(s.angle_rad) - b * std::sin(s.angle_rad));
           });
         return;
       }
       for (const char* channel : {"motor_left_position_rad", "motor_right_position_rad"})
         edits.sensor_law(channel, error);
     }});

}  // namespace
}  // namespace sandhopper::diagnose
