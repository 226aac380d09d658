#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

// Needs a rise of the motor's temperature of at least 3 K.
std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (c.facts.temperature_K < 3.0) return {};
  return {{.name = "derating_per_K", .typical = 1.2e-3, .low = -0.01, .high = 0.02, .either_sign = true}};
}

constexpr double kRoom_C = 25.0;

const EffectRegistration kEffect(
    {.id = "actuator.temperature",
     .port = Port::actuator,
     .statement = "The motors' torque falls as they get warm: the magnets weaken.",
     .equation = "torque = K_t i (1 - c (T - 25 C))",
     .bench_tests = {{.kind = "hop",
                      .sentence = "Record the same hop with cold and with warm motors, each on a freshly "
                                  "prepared bed: only torque that falls with temperature sets the two apart, "
                                  "and neither the bed nor a fixed torque constant.",
                      .same_for = {"actuator.voltage_limit"}}},
     .plants = {PlantKind::hopper},
     .parameters = parameters,
     .apply = [](const Context&, const std::string&, std::span<const double> v, Edits& edits) {
       const double derating = v[0];
       edits.sensor_law("actuator", [=](const SensorState& s) {
         return -derating * (s.temperature_C - kRoom_C) * s.value;
       });
     }});

}  // namespace
}  // namespace sandhopper::diagnose
