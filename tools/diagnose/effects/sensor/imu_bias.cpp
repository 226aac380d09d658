#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(
    {.id = "imu.bias",
     .port = Port::sensor,
     .statement = "{channel} reads a constant amount off.",
     .equation = "y = x + o",
     .plants = {PlantKind::hopper},
     .channels = accelerometers,
     .parameters =
         [](const Context&, const std::string&) {
           return std::vector<EffectParameter>{
               {.name = "bias_mps2", .typical = 0.3, .low = -20.0, .high = 20.0, .either_sign = true}};
         },
     .apply = [](const Context&, const std::string& channel, std::span<const double> v,
                 Edits& edits) { edits.sensor(channel, SensorEdit::Kind::offset, v[0]); }});

}  // namespace
}  // namespace sandhopper::diagnose
