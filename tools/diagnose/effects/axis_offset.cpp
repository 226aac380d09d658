#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(
    {.id = "axis.offset",
     .port = "axis",
     .statement = "A constant torque acts on the axis that the recorded torque does not show.",
     .equation = "tau += tau_0",
     .plants = {PlantKind::rotary_axis},
     .parameters =
         [](const Context& c, const std::string&) {
           const double typical = 0.05 * c.scale("torque_Nm");
           return std::vector<EffectParameter>{{.name = "torque_offset_Nm",
                                                .typical = typical,
                                                .low = -100.0 * typical,
                                                .high = 100.0 * typical,
                                                .either_sign = true}};
         },
     .apply =
         [](const Context&, const std::string&, std::span<const double> v, Edits& edits) {
           const double torque = v[0];
           edits.law("axis", [torque](const PortState&) { return torque; });
         }});

}  // namespace
}  // namespace sandhopper::diagnose
