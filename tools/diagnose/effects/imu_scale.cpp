#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(
    scale_effect("imu.scale", {PlantKind::falling_body, PlantKind::hopper}, [](const Context& c) {
      return present(c, {"accel_mps2", "imu_body_accel_z_mps2", "imu_foot_accel_z_mps2"});
    }));

}  // namespace
}  // namespace sandhopper::diagnose
