#include <algorithm>

#include "tools/conceal/core/fault_recipes.hpp"
#include "tools/conceal/falling_body/world.hpp"

namespace sandhopper::conceal::falling_body {
namespace {

std::vector<std::string> channels(const World& w) {
  std::vector<std::string> all;
  if (w.has_height) all.push_back("height_m");
  if (w.has_accel) all.push_back("accel_mps2");
  return all;
}

// A random one of the channels of this rig; always the accelerometer, if there is one, for `prefer_accel`.
std::string channel_of(const World& w, Random& random, bool prefer_accel) {
  if (!w.has_height) return "accel_mps2";
  if (!w.has_accel) return "height_m";
  return prefer_accel || random.chance(0.5) ? "accel_mps2" : "height_m";
}

Json bias(World& w, double size, Random& random) {
  const auto channel = channel_of(w, random, true);
  const double bias = random.sign() * size * (channel == "height_m" ? 0.05 : 0.25);
  w.faults[channel].offset += bias;
  return {{"channel", channel}, {"bias", bias}};
}

Json saturation(World& w, double size, Random& random) {
  const auto channel = channel_of(w, random, true);
  const double limit = channel == "height_m" ? w.most_release_m / (1.0 + 0.3 * size)
                       : w.has_bed           ? 60.0 / (1.0 + 2.0 * size)
                                             : 2.0 / (1.0 + 2.0 * size);
  w.faults[channel].limit = limit;
  return {{"channel", channel}, {"limit", limit}};
}

Json scale(World& w, double size, Random& random, const char* channel) {
  const double error = random.sign() * size * 0.02;
  w.faults[channel].gain *= 1.0 + error;
  return {{"scale_error", error}};
}

}  // namespace

std::vector<Recipe<World>> sensor_effects() {
  auto all = data_fault_recipes<World>(channels, 0.01);
  append(all, {{{"sensor.bias", "", "sensor"}, bias},
               {{"sensor.saturation", "", "data"}, saturation},
               {{"tof.scale", "", "sensor"},
                [](World& w, double size, Random& r) { return scale(w, size, r, "height_m"); }},
               {{"imu.scale", "", "sensor"},
                [](World& w, double size, Random& r) { return scale(w, 2.0 * size, r, "accel_mps2"); }},
               {{"imu.lag", "", "clock"}, [](World& w, double size, Random&) -> Json {
                  w.faults["accel_mps2"].lag_s = 0.01 * size;
                  return {{"time_constant_s", 0.01 * size}};
                }}});
  return all;
}

}  // namespace sandhopper::conceal::falling_body
