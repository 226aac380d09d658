#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(scale_effect("tof.scale", {PlantKind::falling_body, PlantKind::hopper},
                                              [](const Context& c) {
                                                return present(c, {"height_m", "tof_height_m"});
                                              }));

}  // namespace
}  // namespace sandhopper::diagnose
