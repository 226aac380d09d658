#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(
    {.id = "imu.tilt",
     .port = Port::sensor,
     .statement = "The sensor of {channel} is tilted: it reads the true value times the cosine of the tilt.",
     .equation = "y = x cos(alpha)",
     .bench_tests = {{.kind = "hold",
                      .sentence = "Hold the robot still, lying on each of its sides: if {channel} is tilted "
                                  "it reads opposite parts of gravity on opposite sides, if biased the same, "
                                  "and if only its scale is wrong, zero."}},
     .plants = {PlantKind::hopper},
     .channels = accelerometers,
     .parameters =
         [](const Context&, const std::string&) {
           return std::vector<EffectParameter>{
               {.name = "tilt_rad", .typical = 0.1 * 0.1, .low = 0.0, .high = 0.7 * 0.7, .power = 0.5}};
         },
     .apply =
         [](const Context&, const std::string& channel, std::span<const double> v, Edits& edits) {
           edits.sensor(channel, SensorEdit::Kind::gain, std::cos(std::sqrt(v[0])));
         }});

}  // namespace
}  // namespace sandhopper::diagnose
