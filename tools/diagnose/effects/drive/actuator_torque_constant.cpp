#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(
    {.id = "actuator.torque_constant",
     .port = Port::actuator,
     .statement = "The motors give more or less torque for a current than believed.",
     .equation = "tau = K_t (1 + e) i",
     .bench_tests = {{.sentence =
                          "Turn each motor with open leads and measure voltage over speed: this is the "
                          "torque constant; mass, friction, saturation and load cell have no effect."}},
     .plants = {PlantKind::hopper},
     .parameters =
         [](const Context& c, const std::string&) {
           const double believed = c.belief.value("motor.torque_constant_Nm_per_A", 0.0868);
           return std::vector<EffectParameter>{{.name = "torque_constant_Nm_per_A",
                                                .typical = 0.05,
                                                .low = -0.8,
                                                .high = 2.0,
                                                .either_sign = true,
                                                .base = believed,
                                                .scale = believed}};
         },
     .apply = [](const Context&, const std::string&, std::span<const double> v,
                 Edits& edits) { edits.sensor("actuator", SensorEdit::Kind::gain, 1.0 + v[0]); },
     .belief_key = "motor.torque_constant_Nm_per_A"});

}  // namespace
}  // namespace sandhopper::diagnose
