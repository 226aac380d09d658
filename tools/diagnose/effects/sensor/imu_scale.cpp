#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(scale_effect("imu.scale", {PlantKind::falling_body, PlantKind::hopper},
                                              accelerometers));

}  // namespace
}  // namespace sandhopper::diagnose
