#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context&, const std::string&) {
  const auto factor = [](const char* name) {
    return EffectParameter{.name = name,
                           .typical = 0.05,
                           .low = -0.8,
                           .high = 3.0,
                           .either_sign = true,
                           .base = 1.0,
                           .amplitude = true};
  };
  return {factor("compression_stiffness_factor"), factor("extension_stiffness_factor")};
}

const EffectRegistration kEffect(
    {.id = "controller.not_as_configured",
     .port = Port::controller,
     .statement = "The controller's leg spring has another stiffness than it was set to.",
     .equation = "k_c -> (1 + c) k_c, k_e -> (1 + e) k_e",
     .bench_tests = {{.kind = "clamped",
                      .sentence = "Clamp the body, press the foot in by known steps and read the commanded "
                                  "torque: commands over steps give the stiffness that the controller uses, "
                                  "whatever the motors and the bed do."}},
     .plants = {PlantKind::hopper},
     .parameters = parameters,
     .apply = [](const Context&, const std::string&, std::span<const double> v, Edits& edits) {
       edits.scale("controller.compression_stiffness_N_per_m", 1.0 + v[0]);
       edits.scale("controller.extension_stiffness_N_per_m", 1.0 + v[1]);
     }});

}  // namespace
}  // namespace sandhopper::diagnose
