#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

// Each sensor may have its own clock, or all share one ("all").
const char* const kAll = "all";

// Geometric mean of the usual tolerances of a quartz (5e-5) and of a ceramic resonator (5e-3), by which
// loggers count time.
constexpr double kTypical = 5e-4;

std::vector<std::string> channels(const Context& c) {
  if (c.plant == PlantKind::hopper)
    return present(c, {"load_cell_force_N", "imu_body_accel_z_mps2", "imu_foot_accel_z_mps2", "tof_height_m",
                       "mocap_body_z_m"});
  if (c.plant == PlantKind::intruder) return {intruder_out_of_time(c)};
  std::vector<std::string> found;
  for (const auto& [channel, scale] : c.channels) found.push_back(channel);
  if (c.plant == PlantKind::rotary_axis && c.facts.is_driven) found.emplace_back("torque_Nm");
  if (c.plant == PlantKind::falling_body && found.size() > 1) found.emplace_back(kAll);
  return found;
}

void apply(const Context& c, const std::string& channel, std::span<const double> v, Edits& edits) {
  const double factor = 1.0 / (1.0 + v[0]);
  if (channel == "torque_Nm") return edits.sensor("actuator", SensorEdit::Kind::time_scale, 1.0 / factor);
  for (const auto& [each, scale] : c.channels)
    if (channel == kAll) edits.sensor(each, SensorEdit::Kind::time_scale, factor);
  if (channel != kAll) edits.sensor(channel, SensorEdit::Kind::time_scale, factor);
}

const EffectRegistration kEffect(
    {.id = "clock.drift",
     .port = Port::clock,
     .statement = "The clock of {channel} runs fast or slow by a constant ratio.",
     .equation = "t' = (1 + d) t",
     .bench_tests =
         {{.sentence = "Log {channel} for ten minutes together with a pulse each second from a reference "
                       "clock: only a clock that runs fast or slow drifts steadily away from the pulses."}},
     .plants = {PlantKind::falling_body, PlantKind::rotary_axis, PlantKind::intruder, PlantKind::hopper},
     .channels = channels,
     .parameters =
         [](const Context&, const std::string&) {
           return std::vector<EffectParameter>{
               {.name = "drift", .typical = kTypical, .low = -0.05, .high = 0.05, .either_sign = true}};
         },
     .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
