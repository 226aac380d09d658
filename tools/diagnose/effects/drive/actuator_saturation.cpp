#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

// Torque above which the relative loss no longer grows.
double reference_of(const Context& c) {
  return c.plant == PlantKind::hopper ? c.belief.value("motor.torque_limit_Nm", 2.8) * 2.0
                                      : 3.0 * c.facts.torque_Nm;
}

const EffectRegistration kEffect(
    {.id = "actuator.saturation",
     .port = Port::actuator,
     .statement = "The motor's torque falls behind its current at high torque: the iron saturates.",
     .equation = "torque = reported (1 - s (reported / reference)^2)",
     .bench_tests =
         {{.kind = "clamped",
           .sentence =
               "Block the axis on a load cell and raise the reported torque in steps: saturation takes a "
               "larger part of each further step, while a wrong scale takes the same part of all.",
           .plants = {PlantKind::rotary_axis}},
          {.kind = "clamped",
           .sentence =
               "Clamp the body with the foot on a scale and raise the motor current in steps: saturation "
               "takes a larger part of each further step, a wrong torque constant the same part of all.",
           .plants = {PlantKind::hopper}}},
     .plants = {PlantKind::rotary_axis, PlantKind::hopper},
     .parameters =
         [](const Context& c, const std::string&) {
           std::vector<EffectParameter> all{{.name = "saturation", .typical = 0.15, .low = 0.0, .high = 0.9}};
           // A hopper's torque limit is believed. For other drives the reference torque is not known, so fit
           // it.
           if (c.plant == PlantKind::hopper) return all;
           const double reference_Nm = reference_of(c);
           all.push_back({.name = "reference_Nm",
                          .typical = reference_Nm,
                          .low = 0.2 * reference_Nm,
                          .high = 2.0 * reference_Nm,
                          .shapes = {0.5 * reference_Nm}});
           return all;
         },
     .apply =
         [](const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
           const double s = v[0], reference = v.size() > 1 ? v[1] : reference_of(c);
           edits.sensor_law("actuator", [=](const SensorState& at) {
             const double u = std::min(1.0, std::abs(at.value) / reference);
             return -s * u * u * at.value;
           });
         }});

}  // namespace
}  // namespace sandhopper::diagnose
