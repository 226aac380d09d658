#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(
    {.id = "tof.bias",
     .port = Port::sensor,
     .statement = "The height's zero is not the surface.",
     .equation = "z_recorded = z + o",
     .plants = {PlantKind::hopper},
     .parameters =
         [](const Context& c, const std::string&) {
           if (!c.has("tof_height_m")) return std::vector<EffectParameter>{};
           return std::vector<EffectParameter>{{.name = "bias_m",
                                                .typical = 1e-3,
                                                .low = -0.03,
                                                .high = 0.03,
                                                .either_sign = true,
                                                .scale = -1.0}};
         },
     .apply = [](const Context&, const std::string&, std::span<const double> v,
                 Edits& edits) { edits.sensor("tof_height_m", SensorEdit::Kind::offset, -v[0]); }});

}  // namespace
}  // namespace sandhopper::diagnose
