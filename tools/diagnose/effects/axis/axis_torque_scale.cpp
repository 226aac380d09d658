#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(
    {.id = "axis.torque_scale",
     .port = Port::actuator,
     .statement = "The torque that acts is in proportion to the reported one, but not equal to it.",
     .equation = "torque = (1 + e) reported",
     .bench_tests =
         {{.kind = "hold",
           .sentence =
               "Let the drive hold the arm level without and with a known weight on it: the torque rises by "
               "weight times lever unless its scale is wrong; offsets and the arm itself cancel."}},
     .plants = {PlantKind::rotary_axis},
     .parameters =
         [](const Context&, const std::string&) {
           return std::vector<EffectParameter>{
               {.name = "scale_error", .typical = 0.05, .low = -0.9, .high = 5.0, .either_sign = true}};
         },
     .apply = [](const Context&, const std::string&, std::span<const double> v,
                 Edits& edits) { edits.sensor("actuator", SensorEdit::Kind::gain, 1.0 + v[0]); }});

}  // namespace
}  // namespace sandhopper::diagnose
