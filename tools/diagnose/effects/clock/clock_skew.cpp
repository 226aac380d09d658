#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

// Each sensor's time stamps may be late relative to the others; on an axis, relative to the drive's torque.
// On an intruder, a late force equals an early position; recorded speed or acceleration shows which of the
// two is late.
std::vector<std::string> channels(const Context& c) {
  if (c.plant == PlantKind::rotary_axis) {
    auto found = present(c, {"velocity_radps"});
    if (c.has("position_rad") && c.has("velocity_radps")) found.emplace_back("position_rad");
    if (c.facts.is_driven) found.emplace_back("torque_Nm");
    return found;
  }
  if (c.plant == PlantKind::intruder) return {intruder_out_of_time(c)};
  // The release time is known from the set-up, so even a single channel can be late.
  return present(c, {"height_m", "accel_mps2", "force_N", "load_cell_force_N", "imu_body_accel_z_mps2",
                     "imu_foot_accel_z_mps2", "mocap_body_z_m"});
}

void apply(const Context& c, const std::string& channel, std::span<const double> v, Edits& edits) {
  if (channel == "torque_Nm") {
    edits.sensor("actuator", SensorEdit::Kind::delay_s, -v[0]);
  } else if (channel == "mocap_body_z_m") {
    for (const auto& each : present(c, {"mocap_body_z_m", "mocap_foot_z_m"}))
      edits.sensor(each, SensorEdit::Kind::delay_s, v[0]);
  } else {
    edits.sensor(channel, SensorEdit::Kind::delay_s, v[0]);
  }
}

std::vector<EffectParameter> parameters(const Context& c, const std::string& channel) {
  const auto it = c.channels.find(channel);
  const double step_s = it == c.channels.end() ? 1e-3 : it->second.step_s;
  return {{.name = "skew_s",
           .typical = 2e-3,
           .low = -10.0 * std::max(step_s, 2e-3),
           .high = 10.0 * std::max(step_s, 2e-3),
           .either_sign = true}};
}

const EffectRegistration kEffect(
    {.id = "clock.skew",
     .port = Port::clock,
     .statement = "The time stamps of {channel} are late against the other channels.",
     .equation = "y(t) = x(t - skew)",
     .bench_tests =
         {{.kind = "motion",
           .sentence =
               "Record a sharp step of {channel} and of another channel in the log and on an oscilloscope: a "
               "shift between them that only the log shows is an error of its time stamps.",
           .plants = {PlantKind::rotary_axis}},
          {.kind = "tap",
           .sentence = "Tap the {robot} with a hammer: {channel} shows the blow late but sharp if its time "
                       "stamps are late, smeared if it lags, and on time if a force is the cause.",
           .plants = {PlantKind::falling_body, PlantKind::intruder, PlantKind::hopper}}},
     .plants = {PlantKind::falling_body, PlantKind::rotary_axis, PlantKind::intruder, PlantKind::hopper},
     .channels = channels,
     .parameters = parameters,
     .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
