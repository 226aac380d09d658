#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (!c.has("tof_height_m")) return {};
  const double believed = c.belief.value("sensors.tof_latency_s", 0.002);
  return {{.name = "latency_s",
           .typical = 5e-3,
           .low = -believed,
           .high = 0.05,
           .either_sign = true,
           .base = believed}};
}

const EffectRegistration kEffect(
    {.id = "tof.latency",
     .port = Port::sensor,
     .statement = "The time-of-flight sensor answers later than believed.",
     .equation = "y(t) = x(t - T)",
     .bench_tests =
         {{.kind = "motion",
           .sentence =
               "Jerk the unpowered robot up and down the rail by hand: tof_height_m follows the twice "
               "integrated accelerometer late by one time if it answers late; a bias is there at rest, too.",
           .same_for = {"clock.skew"}}},
     .same_as = {"clock.skew"},
     .plants = {PlantKind::hopper},
     .parameters = parameters,
     .apply = [](const Context&, const std::string&, std::span<const double> v,
                 Edits& edits) { edits.sensor("tof_height_m", SensorEdit::Kind::delay_s, v[0]); },
     .belief_key = "sensors.tof_latency_s"});

}  // namespace
}  // namespace sandhopper::diagnose
