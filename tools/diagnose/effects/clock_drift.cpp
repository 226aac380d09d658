#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(
    {.id = "clock.drift",
     .port = "clock",
     .statement = "The clock runs fast or slow by a constant ratio.",
     .equation = "t' = (1 + d) t",
     .plants = {PlantKind::falling_body},
     .parameters =
         [](const Context&, const std::string&) {
           return std::vector<EffectParameter>{
               {.name = "drift", .typical = 0.01, .low = -0.2, .high = 0.2, .either_sign = true}};
         },
     .apply =
         [](const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
           for (const auto& [channel, scale] : c.channels)
             edits.sensor(channel, SensorEdit::Kind::time_scale, 1.0 / (1.0 + v[0]));
         }});

}  // namespace
}  // namespace sandhopper::diagnose
