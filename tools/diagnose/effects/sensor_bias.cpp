#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

// Half of what the sensor shows over the whole campaign is more than any bias.
std::vector<EffectParameter> parameters(const Context& c, const std::string& channel) {
  const double range = range_of(c, channel);
  return {{.name = "bias_" + unit_of(channel),
           .typical = 0.02 * range,
           .low = -0.5 * range,
           .high = 0.5 * range,
           .either_sign = true}};
}

const EffectRegistration kEffect(
    {.id = "sensor.bias",
     .port = "sensor",
     .statement = "{channel} reads a constant amount off.",
     .equation = "y = x + o",
     .plants = {PlantKind::falling_body, PlantKind::rotary_axis},
     .channels =
         [](const Context& c) {
           return present(c, {"height_m", "accel_mps2", "velocity_radps"});
         },
     .parameters = parameters,
     .apply = [](const Context&, const std::string& channel, std::span<const double> v,
                 Edits& edits) { edits.sensor(channel, SensorEdit::Kind::offset, v[0]); }});

}  // namespace
}  // namespace sandhopper::diagnose
