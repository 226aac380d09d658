#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(
    {.id = "sensor.lag",
     .port = Port::sensor,
     .statement = "{channel} follows with a first-order lag.",
     .equation = "tau y' + y = x",
     .plants = {PlantKind::rotary_axis},
     .channels = [](const Context& c) { return present(c, {"velocity_radps"}); },
     .parameters =
         [](const Context&, const std::string&) {
           return std::vector<EffectParameter>{{.name = "lag_s", .typical = 3e-3, .low = 0.0, .high = 0.1}};
         },
     .apply = [](const Context&, const std::string& channel, std::span<const double> v,
                 Edits& edits) { edits.sensor(channel, SensorEdit::Kind::lag_s, v[0]); }});

}  // namespace
}  // namespace sandhopper::diagnose
