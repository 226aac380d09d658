#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (c.plant == PlantKind::rotary_axis && c.belief.value("axis.gravity_torque_Nm") == 0.0) return {};
  return {{.name = "encoder_offset_rad", .typical = 0.02, .low = -0.5, .high = 0.5, .either_sign = true}};
}

// Channel "" means both motors. If only one encoder is off, the two angles differ and the controller acts on
// their mean.
std::vector<std::string> channels(const Context& c) {
  std::vector<std::string> channels{""};
  const auto motors = present(c, {"motor_left_position_rad", "motor_right_position_rad"});
  if (motors.size() == 2) channels.insert(channels.end(), motors.begin(), motors.end());
  return channels;
}

void apply(const Context& c, const std::string& channel, std::span<const double> v, Edits& edits) {
  if (c.plant == PlantKind::rotary_axis) return edits.sensor("position_rad", SensorEdit::Kind::offset, v[0]);
  for (const char* motor : {"motor_left_position_rad", "motor_right_position_rad"})
    if (channel.empty() || channel == motor) edits.sensor(motor, SensorEdit::Kind::offset, v[0]);
}

const EffectRegistration kEffect(
    {.id = "encoder.offset",
     .port = Port::sensor,
     .statement = "The encoder's zero is off: the angle is not the one that is read.",
     .equation = "y = theta + o",
     .bench_tests =
         {{.kind = "hold",
           .sentence =
               "Let the arm hang with the drive off and check it with a plumb line: if it hangs true and the "
               "reading is not zero, the encoder is off, not a torque or the balance of the arm.",
           .plants = {PlantKind::rotary_axis}},
          {.kind = "hold",
           .sentence = "Hold the leg at two lengths set by gauge blocks: an offset of the encoder is the "
                       "same angle at both, while a wrong link length errs by another angle at each.",
           .plants = {PlantKind::hopper}}},
     .plants = {PlantKind::rotary_axis, PlantKind::hopper},
     .channels = channels,
     .parameters = parameters,
     .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
