#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double limit = 2.0 * c.belief.value("motor.torque_limit_Nm", 2.8);
  return {{.name = "stall_torque_Nm", .typical = 1.0 / limit, .low = 0.0, .high = 4.0 / limit, .power = -1.0},
          {.name = "no_load_speed_radps",
           .typical = 1.0 / 50.0,
           .low = 1.0 / 500.0,
           .high = 1.0 / 10.0,
           .power = -1.0,
           .shapes = {1.0 / 200.0, 1.0 / 25.0}}};
}

// Motor speed in the direction of the torque induces a voltage that reduces the largest torque.
void apply(const Context&, const std::string&, std::span<const double> v, Edits& edits) {
  const double stall_Nm = 1.0 / std::max(v[0], 1e-9), no_load_radps = 1.0 / std::max(v[1], 1e-9);
  edits.law(LawPort::actuator_limit, [=](const DriveState& s) {
    const double along = s.command_Nm >= 0.0 ? s.rate_radps : -s.rate_radps;
    return stall_Nm * (1.0 - along / no_load_radps);
  });
}

const EffectRegistration kEffect(
    {.id = "actuator.voltage_limit",
     .port = Port::actuator,
     .statement =
         "The bus voltage, less the voltage that the motors induce, is too small for the commanded current.",
     .equation = "|i| <= (V - K_e w) / R",
     .bench_tests = {{.kind = "hop",
                      .sentence =
                          "Record the same hop with a higher bus voltage: the current reaches its command "
                          "only if the voltage was the limit; saturation and a wrong torque constant stay."}},
     .plants = {PlantKind::hopper},
     .parameters = parameters,
     .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
