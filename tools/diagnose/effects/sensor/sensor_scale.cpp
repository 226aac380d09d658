#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(scale_effect(
    "sensor.scale",
    {.kind = "motion",
     .sentence =
         "Turn the axis at a steady speed between two marks of known angle: {channel}, or its integral over "
         "time, misses that angle only if its scale is wrong, whatever torque is needed."},
    {PlantKind::rotary_axis}, [](const Context& c) {
      return present(c, {"position_rad", "velocity_radps"});
    }));

}  // namespace
}  // namespace sandhopper::diagnose
