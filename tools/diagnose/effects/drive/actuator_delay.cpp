#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(
    {.id = "actuator.delay",
     .port = Port::actuator,
     .statement = "Torque acts later than it is reported or commanded.",
     .equation = "torque(t) = reported(t - T)",
     .bench_tests =
         {{.kind = "clamped",
           .sentence = "Block the axis on a load cell and record a step of motor current and of its force on "
                       "one oscilloscope: a force that starts late is a delay, and false time stamps show in "
                       "the log alone.",
           .plants = {PlantKind::rotary_axis}},
          {.kind = "clamped",
           .sentence =
               "Clamp the body and record a step of the command and of the motor current on one "
               "oscilloscope: a late current is a delay, which no force, sensor or clock can imitate there.",
           .plants = {PlantKind::hopper}}},
     .plants = {PlantKind::rotary_axis, PlantKind::hopper},
     .parameters =
         [](const Context&, const std::string&) {
           return std::vector<EffectParameter>{
               {.name = "delay_s", .typical = 2e-3, .low = 0.0, .high = 0.03}};
         },
     .apply = [](const Context&, const std::string&, std::span<const double> v,
                 Edits& edits) { edits.sensor("actuator", SensorEdit::Kind::delay_s, v[0]); }});

}  // namespace
}  // namespace sandhopper::diagnose
