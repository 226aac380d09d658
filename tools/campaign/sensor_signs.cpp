#include "tools/campaign/sensor_signs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "tools/campaign/force_at_depth.hpp"
#include "tools/campaign/implausible.hpp"
#include "tools/campaign/signal_noise.hpp"

namespace sandhopper {
namespace {

using enum FindingSeverity;

constexpr double kShortHold_s = 0.5;  // before a body is let go, and after it lies

struct ValueRange {
  double low = INFINITY, high = -INFINITY;
  void take(double value) {
    if (std::isnan(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double width() const { return high - low; }
  double most() const { return std::max(std::abs(low), std::abs(high)); }
};

ValueRange range_of(std::span<const double> values) {
  ValueRange range;
  for (const double value : values) range.take(value);
  return range;
}

// Mean of the first three samples: the rest of a body that hangs when the recording begins may be that short.
double first_mean(std::span<const double> values) {
  constexpr int kFirst = 3;
  double sum = 0.0;
  int count = 0;
  for (const double value : values)
    if (!std::isnan(value) && count < kFirst) sum += value, ++count;
  return count == kFirst ? sum / kFirst : 0.0;
}

// Means over stretches of a fifth of the samples in which the values stay within a tenth of their whole
// range. `strict`: they also vary by less than the mean, because a flight between two landings is no rest.
std::vector<double> means_at_rest(std::span<const double> values, bool strict) {
  constexpr std::size_t kStretches = 5, kFewest = 10;
  std::vector<double> fresh;
  for (const double value : values)
    if (!std::isnan(value)) fresh.push_back(value);
  const std::size_t length = fresh.size() / kStretches;
  std::vector<double> means;
  if (length < kFewest) return means;
  const double whole = range_of(fresh).width();
  for (std::size_t begin = 0; begin + length <= fresh.size(); begin += std::max<std::size_t>(1, length / 4)) {
    const std::span<const double> part(fresh.data() + begin, length);
    const double width = range_of(part).width();
    if (width > 0.1 * whole) continue;
    double sum = 0.0;
    for (const double value : part) sum += value;
    const double mean = sum / static_cast<double>(length);
    if (!strict || width < std::abs(mean)) means.push_back(mean);
  }
  return means;
}

class SignChecker {
 public:
  SignChecker(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
              const RecordingPlaces& places)
      : recording_(recording), campaign_(campaign), trial_(trial), places_(places) {}

  void run() {
    constexpr std::array<std::string_view, 3> kSpecificForces{"accel_mps2", "imu_body_accel_z_mps2",
                                                              "imu_foot_accel_z_mps2"};
    if (recording_.has_time)
      for (const auto channel : kSpecificForces) check_rest(channel);
    check_name();
  }

  void check_push() {
    if (campaign_.plant == CampaignPlant::intruder && trial_.kind != TrialKind::clamped) {
      compare_with_depth();
      check_one_way();
    }
  }

 private:
  void check_rest(std::string_view channel) {
    if (!recording_.has(channel)) return;
    constexpr double kGravity_mps2 = 9.81, kOneG_mps2 = 9.80665, kNear = 0.06;
    const auto near = [](double mean, double value) {
      return std::abs(mean - value) < kNear * std::abs(value);
    };
    // 16 g: the default of sensors.imu_range_mps2. A hopper's flight on its rail reads the rail's
    // friction, which may be 1 m/s2, so there a landing must be within that.
    const double most_g = campaign_.plant == CampaignPlant::hopper ? 16.0 : 200.0;
    const auto any_at = [&](double value, bool strict) {
      return std::ranges::any_of(means_at_rest(recording_.channel(channel), strict),
                                 [&](double mean) { return near(mean, value); });
    };
    if (any_at(kGravity_mps2, false) || near(first_mean(recording_.channel(channel)), kGravity_mps2)) return;
    const auto means = means_at_rest(recording_.channel(channel), true);
    const double most = range_of(recording_.channel(channel)).most();
    const bool beyond = std::ranges::any_of(means, [&](double mean) { return std::abs(mean) > 1.1; });
    for (const double sign : {1.0, -1.0})
      if (any_at(sign, true) && !beyond && most < most_g)
        return add(channel,
                   fmt::format("reads {:.3g} at rest, where gravity alone is 9.81 m/s2: it is in g{}", sign,
                               sign < 0 ? ", and its axis points downward" : ""),
                   sign * kOneG_mps2);
    if (any_at(-kGravity_mps2, true))
      return add(channel, "reads -9.81 m/s2 at rest: its axis points downward, and the channel counts upward",
                 -1.0);
    if (campaign_.plant != CampaignPlant::falling_body) return;
    if (!check_range(channel)) check_weightless(channel);
  }

  // Mean over the rows before the fall in which the height stays; without those of a fall that does not show
  // in the height yet. NaN if they are too few.
  double mean_before_fall(std::span<const double> values) const {
    constexpr std::size_t kFewestAtRest = 10;
    constexpr double kClear = 5.0;  // in standard deviations
    if (!recording_.has("height_m")) return NAN;
    const auto height = recording_.channel("height_m");
    const double clear_m = kClear * noise_of_bends(height);
    const auto first = std::ranges::find_if(height, [](double h) { return !std::isnan(h); });
    std::size_t end = 0;
    while (end < height.size() && !(std::abs(height[end] - *first) > clear_m)) ++end;
    if (end == height.size() || end == 0) return NAN;
    const double until_s = recording_.t_s[end] - std::sqrt(4.0 * clear_m / 9.81);
    double sum = 0.0, count = 0.0;
    for (std::size_t row = 0; row < end && recording_.t_s[row] < until_s; ++row)
      if (!std::isnan(values[row])) sum += values[row], ++count;
    return count < kFewestAtRest ? NAN : sum / count;
  }

  // The ranges of accelerometers (2, 4, 8, 16 g) differ by powers of two.
  bool check_range(std::string_view channel) {
    constexpr double kGravity_mps2 = 9.81, kNearPower = 0.06;  // as kNear
    const double mean = mean_before_fall(recording_.channel(channel));
    for (const double factor : {2.0, 0.5, 4.0, 0.25, 8.0, 0.125}) {
      if (!(std::abs(mean * factor / kGravity_mps2 - 1.0) < kNearPower)) continue;
      add(channel,
          fmt::format("reads {:.3g} m/s2 before the fall, where the height stays and gravity alone is 9.81 "
                      "m/s2, {:.3g} times that: the range of the sensor is another than its scale assumes",
                      mean, factor),
          factor);
      return true;
    }
    return false;
  }

  static std::string weightless_cure(const UsedColumn* column) {
    const std::string other = "name the column of the axis along the fall (9.8 m/s2 at rest)";
    if (column == nullptr) return other;
    if (column->offset != 0.0)
      return fmt::format("{}; if the values are right, confirm them in [columns]: {}", other,
                         confirming_line(*column));
    auto with_gravity = *column;
    with_gravity.offset = kGravity_mps2;
    return fmt::format(
        "{}; or, if gravity was taken out, write {} into [columns]; if the values are right, "
        "confirm them there: {}",
        other, confirming_line(with_gravity), confirming_line(*column));
  }

  // An axis across the fall reads little at rest, too. No throw is weightless for longer than t = 2 v / g, v
  // the stated release speed or a laboratory's 15 m/s, or than a fall from the stated height.
  void check_weightless(std::string_view channel) {
    constexpr double kThrow_mps = 15.0, kLittle_mps2 = 0.5 * kGravity_mps2;
    const double height_m = trial_.number("release_height_m").value_or(0.0);
    const double speed_mps = std::abs(trial_.number("release_speed_mps").value_or(0.0));
    const double fall_s =
        height_m > 0.0 ? 2.0 * std::sqrt(2.0 * height_m / kGravity_mps2) + kShortHold_s : 0.0;
    const double throw_s = 2.0 * std::max(kThrow_mps, speed_mps) / kGravity_mps2;
    const double most_s = height_m > 0.0 && speed_mps <= kThrow_mps ? fall_s : fall_s + throw_s;
    const auto values = recording_.channel(channel);
    double from_s = NAN, longest_s = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (std::isnan(values[i])) continue;
      if (std::abs(values[i]) > kLittle_mps2) {
        from_s = NAN;
        continue;
      }
      if (std::isnan(from_s)) from_s = recording_.t_s[i];
      longest_s = std::max(longest_s, recording_.t_s[i] - from_s);
    }
    if (longest_s <= most_s) return;
    doubt_column(recording_, places_, places_.is_stated(channel), channel,
                 fmt::format("reads less than half of gravity for {:.3g} s on end, and no body falls so long "
                             "here: its axis lies across the fall, or it is without gravity",
                             longest_s),
                 weightless_cure(places_.column_of(channel)));
  }

  // Reports a column that is an acceleration without gravity by its name (phones write it); a specific force
  // includes gravity.
  void check_name() {
    for (const auto& mapping : trial_.columns) {
      if (mapping.channel != "accel_mps2" || mapping.offset != 0.0 || !recording_.has(mapping.channel))
        continue;
      std::string lower = mapping.column;
      for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
      if (lower.find("linear acc") == std::string::npos && lower.find("without g") == std::string::npos)
        continue;
      add_implausible(
          recording_, places_, trial_unusable, mapping.channel,
          fmt::format("column \"{}\" is an acceleration without gravity by its name, and the channel is a "
                      "specific force",
                      mapping.column),
          fmt::format("add the gravity: {} = {{ column = \"{}\", offset = 9.81 }}", mapping.channel,
                      mapping.column));
    }
  }

  // Compares the position of the rows with the largest fifth of the forces with the range of positions.
  void compare_with_depth() {
    if (!recording_.has("force_N") || !recording_.has("foot_z_m")) return;
    const ForceAtDepth pairs(recording_);
    const auto forces = range_of(pairs.force_N), heights = range_of(pairs.z_m);
    constexpr std::size_t kFewest = 20;
    if (pairs.size() < kFewest || !(heights.width() > 0.0) || !(forces.most() > 0.0)) return;
    const bool negative = -forces.low > 5.0 * std::max(forces.high, 0.0);
    if (negative)
      return add("force_N",
                 "is negative where it is largest: a bed pushes, and the channel counts compression", -1.0);
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < pairs.size(); ++i)
      if (pairs.force_N[i] > forces.low + 0.8 * forces.width()) sum += pairs.z_m[i], count += 1.0;
    const double place = (sum / count - heights.low) / heights.width();  // 0: lowest, 1: highest
    // A depth that counts downward is mostly positive: the part above the surface is short.
    if (place > 0.8 && heights.low > -0.5 * heights.width())
      add("foot_z_m",
          "is highest where the force is largest: it counts the depth downward, and the channel counts "
          "upward",
          -1.0);
  }

  // Doubts a depth that never goes back, while the force falls to that of the air and stays there: the foot
  // came out of the bed. A depth that was stopped, or that goes on by less than a tenth, shows no way back.
  void check_one_way() {
    constexpr std::size_t kAirRows = 10;
    constexpr double kClear = 5.0, kGoesOn = 0.1;  // standard deviations; of the depth at the fall
    if (!recording_.has("force_N") || !recording_.has("foot_z_m") || !recording_.has_time) return;
    const ForceAtDepth pairs(recording_);
    if (pairs.size() < 3 * kAirRows) return;
    double air_N = 0.0;
    for (std::size_t i = 0; i < kAirRows; ++i) air_N += pairs.force_N[i] / kAirRows;
    const double clear_N = kClear * noise_of_bends(pairs.force_N);
    const double clear_m = kClear * noise_of_bends(pairs.z_m);
    std::size_t released = pairs.size();
    while (released > 0 && std::abs(pairs.force_N[released - 1] - air_N) <= clear_N) --released;
    if (released == 0 || pairs.size() - released < kAirRows || pairs.z_m[kAirRows - 1] < 0.0) return;
    double deepest_m = -pairs.z_m.front();
    for (const double z_m : pairs.z_m) {
      if (-z_m < deepest_m - clear_m) return;
      deepest_m = std::max(deepest_m, -z_m);
    }
    const double released_m = -pairs.z_m[released - 1], on_m = deepest_m - released_m;
    if (!(released_m > 0.0) || on_m <= std::max(clear_m, kGoesOn * released_m)) return;
    doubt_column(
        recording_, places_, places_.is_stated("foot_z_m"), "foot_z_m",
        fmt::format("grows from {:.3g} to {:.3g} mm after the force fell back to that of the air, and "
                    "never goes back: a foot without force is out of the bed, and the depth counts "
                    "the way back as further depth",
                    1e3 * released_m, 1e3 * deepest_m),
        fmt::format("count it with its direction, or end the trial where the foot turns: select = {{ "
                    "to_line = {} }}",
                    places_.line_of(pairs.rows[turn_of(pairs.force_N, clear_N)])));
  }

  // Last row before the force falls for good.
  static std::size_t turn_of(const std::vector<double>& force_N, double clear_N) {
    std::size_t peak = 0;
    for (std::size_t i = 0; i < force_N.size(); ++i)
      if (force_N[i] >= force_N[peak]) peak = i;
    while (peak + 1 < force_N.size() && force_N[peak + 1] > force_N[peak] - clear_N) ++peak;
    return peak;
  }

  // `factor`: from the present values to the true ones; -1 also turns the offset.
  void add(std::string_view channel, std::string what, double factor) {
    const auto* used = places_.column_of(channel);
    const bool turned = factor == -1.0;
    const auto line =
        used == nullptr ? "" : mapping_line(turned ? reversed(*used) : in_other_unit(*used, factor));
    doubt_column(recording_, places_, places_.is_stated(channel), channel, std::move(what),
                 fmt::format("write {} into [columns]", line));
  }

  TrialRecording& recording_;
  const Campaign& campaign_;
  const CampaignTrial& trial_;
  const RecordingPlaces& places_;
};

}  // namespace

void check_signs(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                 const RecordingPlaces& places) {
  SignChecker(recording, campaign, trial, places).run();
}

void check_push_signs(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                      const RecordingPlaces& places) {
  SignChecker(recording, campaign, trial, places).check_push();
}

}  // namespace sandhopper
