#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(
    {.id = "sensor.scale",
     .port = "sensor",
     .statement = "{channel} reads in proportion too much or too little.",
     .equation = "y = (1 + s) x",
     .plants = {PlantKind::rotary_axis},
     .channels =
         [](const Context& c) {
           return present(c, {"position_rad", "velocity_radps"});
         },
     .parameters =
         [](const Context&, const std::string&) {
           return std::vector<EffectParameter>{{.name = "scale",
                                                .typical = 0.02,
                                                .low = -0.5,
                                                .high = 1.0,
                                                .either_sign = true,
                                                .base = 1.0}};
         },
     .apply = [](const Context&, const std::string& channel, std::span<const double> v,
                 Edits& edits) { edits.sensor(channel, SensorEdit::Kind::gain, 1.0 + v[0]); }});

}  // namespace
}  // namespace sandhopper::diagnose
