#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(
    {.id = "controller.not_as_configured",
     .port = "controller",
     .statement = "The controller's leg spring pushes off with another stiffness than it was set to.",
     .equation = "k_e -> (1 + e) k_e",
     .plants = {PlantKind::hopper},
     .parameters =
         [](const Context&, const std::string&) {
           return std::vector<EffectParameter>{{.name = "extension_stiffness_factor",
                                                .typical = 0.05,
                                                .low = -0.8,
                                                .high = 3.0,
                                                .either_sign = true,
                                                .base = 1.0}};
         },
     .apply = [](const Context&, const std::string&, std::span<const double> v,
                 Edits& edits) { edits.scale("controller.extension_stiffness_N_per_m", 1.0 + v[0]); }});

}  // namespace
}  // namespace sandhopper::diagnose
