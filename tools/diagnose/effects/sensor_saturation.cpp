#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr double kPileUp = 0.02;  // of all samples exactly on the end value

// The end of the range is where samples pile up; how far the sensor is really cut there is fitted, 1 wholly.
struct End {
  bool high = false;
  double limit = 0.0;
  bool found = false;
};
End end_of(const Context& c, const std::string& channel) {
  const auto it = c.channels.find(channel);
  if (it == c.channels.end()) return {};
  const auto& s = it->second;
  if (s.share_at_high > kPileUp && s.share_at_high >= s.share_at_low) return {true, s.high, true};
  if (s.share_at_low > kPileUp) return {false, s.low, true};
  return {};
}

std::vector<EffectParameter> parameters(const Context& c, const std::string& channel) {
  const End end = end_of(c, channel);
  if (!end.found) return {};
  return {{.name = "limit_" + unit_of(channel),
           .typical = 1.0,
           .low = 0.0,
           .high = 1.5,
           .base = end.limit,
           .scale = 0.0}};
}

void apply(const Context& c, const std::string& channel, std::span<const double> v, Edits& edits) {
  const End end = end_of(c, channel);
  const double share = v[0];
  edits.sensor_law(channel, [end, share](const PortState& s) {
    const double beyond =
        end.high ? std::max(0.0, s.position - end.limit) : std::min(0.0, s.position - end.limit);
    return -share * beyond;
  });
}

std::vector<std::string> channels(const Context& c) {
  std::vector<std::string> found;
  for (const auto& [channel, scale] : c.channels)
    if (!channel.starts_with("imu_")) found.push_back(channel);
  return found;
}

const EffectRegistration kEffect(
    {.id = "sensor.saturation",
     .port = "sensor",
     .statement = "{channel} stops at the end of its range while the quantity goes on.",
     .equation = "y = min(x, limit)",
     .plants = {PlantKind::falling_body, PlantKind::rotary_axis, PlantKind::intruder, PlantKind::hopper},
     .channels = channels,
     .parameters = parameters,
     .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
