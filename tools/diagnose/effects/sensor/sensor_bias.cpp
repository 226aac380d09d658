#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string& channel) {
  if (c.plant == PlantKind::intruder)
    return {{.name = "bias_m",
             .typical = 1e-3,
             .low = -0.03,
             .high = 0.03,
             .either_sign = true,
             .central_step = kSurfaceStep_m}};
  if (channel == "torque_Nm") {
    const double typical = 0.05 * c.facts.torque_Nm;
    return {{.name = "bias_Nm",
             .typical = typical,
             .low = -100.0 * typical,
             .high = 100.0 * typical,
             .either_sign = true}};
  }
  return {bias_parameter(unit_of(channel), range_of(c, channel))};
}

const EffectRegistration kEffect(
    {.id = "sensor.bias",
     .port = Port::sensor,
     .statement = "{channel} reads too much or too little by a constant.",
     .equation = "y = x + o",
     .bench_tests =
         {{.kind = "hold",
           .sentence = "Hold the body still at two known heights: a bias of {channel} is the same at both, a "
                       "wrong scale errs in proportion to the height, and no force acts on a body at rest.",
           .plants = {PlantKind::falling_body}},
          {.kind = "hold",
           .sentence = "Hold the axis still where it rests with the drive off: {channel} must read zero "
                       "there; anything else is its bias, because no torque, friction or inertia acts.",
           .plants = {PlantKind::rotary_axis}},
          {.kind = "press",
           .sentence =
               "Lower the plate slowly until it just pinches a sheet of paper on the bed: {channel} is not "
               "zero there only if it is biased, while crust, tilt and depth laws need more force or depth.",
           .same_for = {"terrain.crater"},
           .plants = {PlantKind::intruder}}},
     .plants = {PlantKind::falling_body, PlantKind::rotary_axis, PlantKind::intruder},
     .channels =
         [](const Context& c) {
           auto found = present(c, {"height_m", "velocity_radps"});
           // A drive that is off has no reading of its torque.
           if (c.plant == PlantKind::rotary_axis && c.facts.is_driven) found.emplace_back("torque_Nm");
           if (c.plant == PlantKind::intruder) found.emplace_back("foot_z_m");
           return found;
         },
     .parameters = parameters,
     .apply =
         [](const Context&, const std::string& channel, std::span<const double> v, Edits& edits) {
           // The torque is an input: the acting torque is the reading minus the bias.
           const bool torque = channel == "torque_Nm";
           edits.sensor(torque ? "actuator" : channel, SensorEdit::Kind::offset, torque ? -v[0] : v[0]);
         }});

}  // namespace
}  // namespace sandhopper::diagnose
