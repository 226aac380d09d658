#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const BenchTest kUpsideDown{
    .kind = "hold",
    .sentence =
        "Hold the {robot} still upright and upside down: the mean of the two readings of {channel} is its "
        "bias, while a wrong scale or a tilt cancels in it."};

void apply(const Context&, const std::string& channel, std::span<const double> v, Edits& edits) {
  edits.sensor(channel, SensorEdit::Kind::offset, v[0]);
}

// An accelerometer that falls reads next to nothing. It may be off by as much as it reads at rest.
std::vector<EffectParameter> parameters_in_fall(const Context& c, const std::string& channel) {
  return {bias_parameter("mps2", std::max(range_of(c, channel), c.belief.value("gravity_mps2", 9.81)))};
}

const EffectRegistration kEffect(
    {.id = "imu.bias",
     .port = Port::sensor,
     .statement = "{channel} reads too much or too little by a constant.",
     .equation = "y = x + o",
     .bench_tests = {kUpsideDown},
     .plants = {PlantKind::hopper},
     .channels = accelerometers,
     .parameters =
         [](const Context&, const std::string&) {
           return std::vector<EffectParameter>{
               {.name = "bias_mps2", .typical = 0.3, .low = -20.0, .high = 20.0, .either_sign = true}};
         },
     .apply = apply});

const EffectRegistration kInFall({.id = "imu.bias",
                                  .port = Port::sensor,
                                  .statement = "{channel} reads too much or too little by a constant.",
                                  .equation = "y = x + o",
                                  .bench_tests = {kUpsideDown},
                                  .same_as = {"sensor.bias"},
                                  .plants = {PlantKind::falling_body},
                                  .channels = accelerometers,
                                  .parameters = parameters_in_fall,
                                  .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
