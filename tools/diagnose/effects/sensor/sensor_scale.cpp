#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(scale_effect("sensor.scale", {PlantKind::rotary_axis}, [](const Context& c) {
  return present(c, {"position_rad", "velocity_radps"});
}));

}  // namespace
}  // namespace sandhopper::diagnose
