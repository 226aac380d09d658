#pragma once
#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "tools/diagnose/model/effect.hpp"
#include "tools/diagnose/model/sign_smooth.hpp"

// Helpers shared by the effects.
namespace sandhopper::diagnose {

// Friction laws are continuous: below this speed they go to zero.
inline constexpr double kSwitchSpeed_mps = 0.01;

// Those of the given channels that the campaign predicts.
inline std::vector<std::string> present(const Context& context, std::initializer_list<const char*> channels) {
  std::vector<std::string> found;
  for (const char* channel : channels)
    if (context.has(channel)) found.emplace_back(channel);
  return found;
}

inline std::vector<std::string> load_cells(const Context& context) {
  return present(context, {"force_N", "load_cell_force_N"});
}

inline std::vector<std::string> accelerometers(const Context& context) {
  return present(context, {"accel_mps2", "imu_body_accel_z_mps2", "imu_foot_accel_z_mps2"});
}

// An intruder's position and force have no common reference in time, so only one of the two can be called
// late: the one whose clock is in doubt.
inline std::string intruder_out_of_time(const Context& context) {
  return context.facts.position_is_out_of_time ? "foot_z_m" : "force_N";
}

// True if the campaign has ground; a falling body may have none.
inline bool has_bed(const Context& context) {
  return context.plant != PlantKind::falling_body || context.belief.value("bed.stiffness_N_per_m") > 0.0;
}

// Fraction of a ground law that acts at a depth: 0 at the surface, nearly 1 far below `over_m`.
inline double come_in(double depth_m, double over_m, double power = 1.0) {
  return 1.0 - std::exp(-std::pow(std::max(0.0, depth_m) / over_m, power));
}

// Adds the depth over which a law of speed starts. A falling body is not recorded well enough on the bed to
// fit it.
inline void add_onset(const Context& context, std::vector<EffectParameter>& parameters) {
  if (context.plant != PlantKind::falling_body)
    parameters.push_back(
        {.name = "onset_depth_m", .typical = 1e-3, .low = 1e-5, .high = 0.01, .shapes = {3e-3}});
}
// The onset depth is the second parameter if it exists.
inline double onset_of(std::span<const double> values) { return values.size() > 1 ? values[1] : 1e-5; }

// `part_of_unloading`: a stiffer bed has a larger loading force. This fraction of the increase also applies
// to the unloading line.
inline EffectParameter part_of_unloading() {
  return {.name = "part_of_unloading",
          .typical = 1.0,
          .low = 0.0,
          .high = 1.0,
          .shapes = {0.0},
          .is_whole_range = true};
}
// Multiplies the quasi-static force by 1 + share(state), and the unloading line by 1 + part * share(state).
// `share`: a function of GroundState.
template <class Share>
void stiffen(Edits& edits, double part, const Share& share) {
  edits.law(LawPort::ground_factor, share);
  edits.law(LawPort::ground_unloading, [=](const GroundState& s) { return part * share(s); });
}

// Bias of a sensor: at most half of `range`, the range of the channel's values.
inline EffectParameter bias_parameter(const std::string& unit, double range) {
  return {.name = "bias_" + unit,
          .typical = 0.02 * range,
          .low = -0.5 * range,
          .high = 0.5 * range,
          .either_sign = true};
}

// Parameters and edit of a sensor that follows with two first-order lags in series. `lag_s` is their sum, the
// delay of a slow signal; `second_lag_part` of it is the second's. 0: first order; 1/2: two equal lags.
inline std::vector<EffectParameter> lag_parameters() {
  return {{.name = "lag_s", .typical = 3e-3, .low = 0.0, .high = 0.1},
          {.name = "second_lag_part", .typical = 0.25, .low = 0.0, .high = 0.5, .is_whole_range = true}};
}
inline void add_lag(Edits& edits, const std::string& channel, std::span<const double> values) {
  const double second_s = values.size() > 1 ? values[1] * values[0] : 0.0;
  edits.sensor(channel, SensorEdit::Kind::lag_s, values[0] - second_s);
  if (second_s > 0.0) edits.sensor(channel, SensorEdit::Kind::lag_s, second_s);
}

// Range of a channel's values over the campaign, at least 1e-12; 1 if the channel is not predicted.
inline double range_of(const Context& context, const std::string& channel) {
  const auto it = context.channels.find(channel);
  return it == context.channels.end() ? 1.0 : std::max(it->second.high - it->second.low, 1e-12);
}

// Unit at the end of a channel's name ("m" of "height_m"), for the names of parameters.
inline std::string unit_of(const std::string& channel) {
  for (const char* unit : {"mps2", "radps", "mps", "rad", "Nm", "N", "m", "Pa", "A"})
    if (channel.ends_with(std::string("_") + unit)) return unit;
  return "unit";
}

// A number of nominal.toml, key "table.key"; `otherwise` if the file does not state it.
struct BelievedNumber {
  const char* key;
  double otherwise = 0.0;
  double of(const Context& context) const { return context.belief.value(key, otherwise); }
};

// Completes an effect whose parameters are added, in this order, to numbers of the belief.
inline Effect adds_to(std::vector<BelievedNumber> numbers, Effect effect) {
  effect.apply = [numbers](const Context&, const std::string&, std::span<const double> v, Edits& edits) {
    for (std::size_t i = 0; i < numbers.size(); ++i) edits.add(numbers[i].key, v[i]);
  };
  effect.as_keys = [numbers](const Context& context, std::span<const double> v,
                             std::map<std::string, double>& keys) {
    for (std::size_t i = 0; i < numbers.size(); ++i) keys[numbers[i].key] = numbers[i].of(context) + v[i];
    return true;
  };
  return effect;
}

// Effect "gain error of a sensor", under the name that this kind of sensor uses.
inline Effect scale_effect(std::string id, BenchTest bench_test, std::vector<PlantKind> plants,
                           std::function<std::vector<std::string>(const Context&)> channels) {
  return {.id = std::move(id),
          .port = Port::sensor,
          .statement = "{channel} reads in proportion too much or too little.",
          .equation = "y = (1 + s) x",
          .bench_tests = {std::move(bench_test)},
          .plants = std::move(plants),
          .channels = std::move(channels),
          .parameters =
              [](const Context&, const std::string&) {
                return std::vector<EffectParameter>{
                    {.name = "scale_error", .typical = 0.02, .low = -0.3, .high = 0.4, .either_sign = true}};
              },
          .apply = [](const Context&, const std::string& channel, std::span<const double> v,
                      Edits& edits) { edits.sensor(channel, SensorEdit::Kind::gain, 1.0 + v[0]); }};
}

}  // namespace sandhopper::diagnose
