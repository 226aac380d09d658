#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(scale_effect(
    "imu.scale",
    {.kind = "hold",
     .sentence =
         "Hold the {robot} still in many attitudes: the highest and lowest reading of {channel} are not 2 g "
         "apart if its scale is wrong; a bias shifts both and a tilt only moves where they are."},
    {PlantKind::falling_body, PlantKind::hopper}, accelerometers));

}  // namespace
}  // namespace sandhopper::diagnose
