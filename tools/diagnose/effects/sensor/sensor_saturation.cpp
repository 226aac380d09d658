#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

// Least fraction of all samples at the end value, exactly or within the noise. Set by hand.
constexpr double kPileUp = 0.02;

// A range ends at a value at which samples accumulate. The fitted parameter is the degree of clamping: 1
// means a hard limit.
struct SensorRange {
  double low = -1e300, high = 1e300;
  bool found = false;
  double limit = 0.0;       // as reported
  double resolution = 0.0;  // Half a step of the channel's grid, because the limit is rounded to it.
};
SensorRange sensor_range(const Context& c, const std::string& channel) {
  SensorRange range;
  const auto it = c.channels.find(channel);
  if (it == c.channels.end()) return range;
  const auto& s = it->second;
  const bool symmetric = std::abs(s.high + s.low) < 0.5 * s.grid + 1e-9 * s.high;
  const double both = symmetric ? s.share_at_high + s.share_at_low : 0.0;
  range.resolution = 0.5 * s.grid;
  if (std::max(s.share_at_low, both) > kPileUp) range.low = s.low;
  if (std::max(s.share_at_high, both) > kPileUp) range.high = s.high;
  const bool at_low = range.low == s.low, at_high = range.high == s.high;
  range.found = at_low || at_high;
  range.limit = at_high && (symmetric || !at_low || s.share_at_high >= s.share_at_low) ? s.high : s.low;
  return range;
}

// The range ends before the sensor's noise is added: samples scatter around the limit, so the limit is
// fitted, as 1 / limit.
std::vector<EffectParameter> limit_under_noise(const Context& c, const std::string& channel) {
  const auto it = c.channels.find(channel);
  // A hopper's drives and accelerometers have limits of their own: actuator.saturation, imu.clipping.
  if (it == c.channels.end() || c.plant == PlantKind::hopper) return {};
  const auto& s = it->second;
  const double end = std::max(std::abs(s.low), std::abs(s.high));
  // Twice the share that samples spread evenly over the range would have there.
  const double by_chance = 2.0 * kNoiseBand * s.noise_rms / std::max(s.high - s.low, 1e-12);
  if (end == 0.0 || s.share_near_end < std::max(kPileUp, by_chance)) return {};
  return {{.name = "limit_" + unit_of(channel),
           .typical = 1.0 / end,
           .low = 0.0,
           .high = 3.0 / end,
           .power = -1.0,
           .shapes = {1.0 / end}}};
}

std::vector<EffectParameter> parameters(const Context& c, const std::string& channel) {
  const SensorRange range = sensor_range(c, channel);
  if (!range.found) return limit_under_noise(c, channel);
  return {{.name = "limit_" + unit_of(channel),
           .typical = 1.0,
           .low = 0.0,
           .high = 1.5,
           .base = range.limit,
           .scale = 0.0,
           .resolution = range.resolution}};
}

void apply(const Context& c, const std::string& channel, std::span<const double> v, Edits& edits) {
  const SensorRange range = sensor_range(c, channel);
  if (!range.found) {
    if (v[0] <= 0.0) return;
    const double limit = 1.0 / v[0];
    edits.sensor_law(channel,
                     [limit](const SensorState& s) { return std::clamp(s.value, -limit, limit) - s.value; });
    return;
  }
  const double share = v[0];
  edits.sensor_law(channel, [range, share](const SensorState& s) {
    return share * (std::clamp(s.value, range.low, range.high) - s.value);
  });
}

std::vector<std::string> channels(const Context& c) {
  std::vector<std::string> found;
  for (const auto& [channel, scale] : c.channels)
    if (!channel.starts_with("imu_") && !channel.starts_with("command_")) found.push_back(channel);
  return found;
}

const EffectRegistration kEffect(
    {.id = "sensor.saturation",
     .port = Port::sensor,
     .statement = "{channel} stays at the end of its range while the quantity continues to change.",
     .equation = "y = min(x, limit), |y| <= limit under noise",
     .bench_tests = {{.sentence = "Move what {channel} measures slowly past its highest recorded value "
                                  "beside a second gauge: the reading stops there, although nothing moves "
                                  "fast, only if the range of the sensor ends."}},
     .plants = {PlantKind::falling_body, PlantKind::rotary_axis, PlantKind::intruder, PlantKind::hopper},
     .channels = channels,
     .parameters = parameters,
     .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
