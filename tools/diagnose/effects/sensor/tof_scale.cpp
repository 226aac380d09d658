#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(scale_effect(
    "tof.scale",
    {.kind = "hold",
     .sentence = "Hold the {robot} still at two known heights: {channel} errs in proportion to the height if "
                 "its scale is wrong, by the same at both if its zero is, and no force matters at rest."},
    {PlantKind::falling_body, PlantKind::hopper}, [](const Context& c) {
      return present(c, {"height_m", "tof_height_m"});
    }));

}  // namespace
}  // namespace sandhopper::diagnose
