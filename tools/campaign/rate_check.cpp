#include "tools/campaign/rate_check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "tools/campaign/flat_ends.hpp"
#include "tools/campaign/implausible.hpp"
#include "tools/campaign/signal_noise.hpp"

namespace sandhopper {
namespace {

using enum FindingSeverity;

// `speed` is the rate of `position`.
struct Pair {
  std::string_view position, speed;
};
constexpr std::array kPairs{Pair{"position_rad", "velocity_radps"}, Pair{"foot_z_m", "foot_velocity_mps"},
                            Pair{"foot_velocity_mps", "foot_accel_mps2"},
                            Pair{"motor_left_position_rad", "motor_left_velocity_radps"},
                            Pair{"motor_right_position_rad", "motor_right_velocity_radps"}};

// v = slope dx/dt; `together`: squared correlation.
struct Slope {
  double slope = 0.0, together = 0.0;
};
constexpr double kCorrelates = 0.8;
constexpr double kOneRatio = 0.98;  // of clean data; a sine against its square wave has 8 / pi^2 = 0.81

// Ratios of the units of a position, a speed and a time, and the unit that explains them.
struct Known {
  double ratio;
  std::string_view text;
};
constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr std::array kKnown{
    Known{kDegrees, "57.3: the speed in deg/s, or the position in rad taken for degrees"},
    Known{1.0 / kDegrees, "0.01745: the position in degrees, or the speed in rad/s taken for deg/s"},
    Known{30.0 / std::numbers::pi, "9.55: the speed in rpm"},
    Known{1.0 / 6.0, "1/6: the position in degrees and the speed in rpm"},
    Known{2.0 * std::numbers::pi, "6.28: the position in turns"},
    Known{0.5 / std::numbers::pi, "0.159: the speed in turns a second"},
    Known{1e3, "1000: the speed in mm/s or mrad/s, or the position or time in units 1000 times larger"},
    Known{1e-3, "0.001: the position in mm or mrad, or the time in ms"},
    Known{100.0, "100: the speed in cm/s"},
    Known{0.01, "0.01: the position in cm"},
    Known{10.0, "10: mm for cm"},
    Known{0.1, "0.1: cm for mm"},
    Known{1.0 / 9.80665, "0.102: an acceleration in g"},
    Known{1.0 / 0.0254, "39.4: the speed in in/s"},
    Known{0.0254, "0.0254: the position in inches"},
    Known{2.54, "2.54: inches for cm"},
    Known{1.0 / 2.54, "0.394: cm for inches"},
    Known{25.4, "25.4: inches for mm"},
    Known{1.0 / 25.4, "0.0394: mm for inches"},
    Known{1.0 / 0.3048, "3.28: the speed in ft/s"},
    Known{0.3048, "0.305: the position in ft"},
    Known{3.6, "3.6: the speed in km/h"},
    Known{60.0, "60: the time in minutes, or the speed per minute"},
    Known{2.0, "2: the speed of a gear side that turns twice as fast, or a time twice as long"},
    Known{0.5, "0.5: the position of a gear side that turns twice as fast, or a time half as long"},
    Known{3.0, "3: the speed of a gear side that turns three times as fast, or a time three times as long"},
    Known{1.0 / 3.0,
          "0.333: the position of a gear side that turns three times as fast, or a time a third as long"}};

// A ratio that a time of another scale explains as well as a gear does.
bool is_of_gear(const Known& known) { return known.text.find("gear") != std::string_view::npos; }

class RateChecker {
 public:
  RateChecker(TrialRecording& recording, const RecordingPlaces& places)
      : recording_(recording), places_(places) {}

  void run() {
    for (const auto& pair : kPairs) {
      if (!recording_.has(pair.position) || !recording_.has(pair.speed)) continue;
      if (look_for_lost_sign(pair)) continue;
      const auto found = slope(pair.position, pair.speed);
      if (!found || look_for_crossing(pair, *found) || look_for_exchange(pair, *found)) continue;
      if (found->together > kCorrelates) judge(pair, *found);
    }
  }

 private:
  // A speed that is never negative, and follows the magnitude of the rate of its position where that falls
  // as where it rises. An acceleration may be positive throughout, and a speed that is cut off at 0 follows
  // nothing where the position falls.
  bool look_for_lost_sign(const Pair& pair) {
    const auto x = recording_.channel(pair.position), v = recording_.channel(pair.speed);
    if (pair.position == "foot_velocity_mps" || std::ranges::any_of(v, [](double s) { return s < 0.0; }))
      return false;
    const auto span = clear_span(x);
    const auto rising = one_way_slope(x, v, span, 1.0), falling = one_way_slope(x, v, span, -1.0);
    if (!rising || !falling || rising->together < kCorrelates || falling->together < kCorrelates)
      return false;
    add(pair.speed,
        fmt::format("is never negative, and where {} falls it follows the magnitude of that rate "
                    "(correlation {:.2f}): the speed has no sign",
                    pair.position, std::sqrt(falling->together)),
        "record it with its sign, or rename the column: a speed is not needed beside a position",
        is_stated(pair.position, pair.speed));
    return true;
  }

  // The fewest rows over which a position moves clearly beside its noise; half of the rows at most.
  static std::size_t clear_span(std::span<const double> x) {
    constexpr double kClear = 5.0;  // in standard deviations of the difference of two samples
    const double clear = kClear * std::numbers::sqrt2 * noise_of_bends(x);
    std::size_t span = 1;
    for (; 2 * span < x.size() / 2; span *= 2) {
      double squares = 0.0, steps = 0.0;
      for (std::size_t i = span; i < x.size(); ++i)
        if (const double step = x[i] - x[i - span]; !std::isnan(step)) squares += step * step, ++steps;
      if (steps > 0.0 && std::sqrt(squares / steps) > clear) break;
    }
    return span;
  }

  // Slope of the speed against the magnitude of the rate, over the steps of `span` rows that go in one
  // direction.
  std::optional<Slope> one_way_slope(std::span<const double> x, std::span<const double> v, std::size_t span,
                                     double sign) const {
    double dd = 0.0, dv = 0.0, vv = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i + span < x.size(); ++i) {
      const double rate = sign * (x[i + span] - x[i]) / (recording_.t_s[i + span] - recording_.t_s[i]);
      const double speed = 0.5 * (v[i] + v[i + span]);
      if (!(rate > 0.0) || std::isnan(speed)) continue;
      dd += rate * rate, dv += rate * speed, vv += speed * speed;
      ++count;
    }
    if (count < 10 || vv <= 0.0) return std::nullopt;
    return Slope{dv / dd, dv * dv / (dd * vv)};
  }

  // From the rows in which neither stands at an end of its range, where these correlate: a speed that is
  // clipped is no speed in another unit, whose ratio is the same at all speeds.
  std::optional<Slope> slope(std::string_view position, std::string_view speed) const {
    const auto x = recording_.channel(position), v = recording_.channel(speed);
    auto ends = stands_at_an_end(v);
    const auto ends_of_position = stands_at_an_end(x);
    for (std::size_t i = 0; i < ends.size(); ++i) ends[i] = ends[i] || ends_of_position[i];
    const auto all = slope_of(x, v, std::vector<bool>(ends.size(), false));
    if (std::ranges::count(ends, true) == 0) return all;
    const auto between = slope_of(x, v, ends);
    const bool is_correlated_between = between && between->together > kCorrelates;
    if (!is_correlated_between && all && all->together >= kOneRatio) return all;
    return between;
  }

  // Windows end before a row that is `left_out`.
  std::optional<Slope> slope_of(std::span<const double> x, std::span<const double> v,
                                const std::vector<bool>& left_out) const {
    const std::size_t n = recording_.rows(), span = std::max<std::size_t>(1, n / 20);
    double dd = 0.0, dv = 0.0, vv = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i + 1 < n; ++i) {
      std::size_t end = i;
      while (end < std::min(i + span, n - 1) && !left_out[i] && !left_out[end + 1]) ++end;
      if (end == i || std::isnan(x[i]) || std::isnan(x[end])) continue;
      if (end < i + span && !left_out_after(end, left_out)) break;  // the end of the recording
      double mean = 0.0;
      std::size_t samples = 0;
      for (std::size_t k = i; k <= end; ++k)
        if (!std::isnan(v[k])) mean += v[k], ++samples;
      const double step_s = recording_.t_s[end] - recording_.t_s[i];
      if (samples == 0 || !(step_s > 0.0)) continue;
      mean /= static_cast<double>(samples);
      const double rate = (x[end] - x[i]) / step_s;
      dd += rate * rate, dv += rate * mean, vv += mean * mean;
      ++count;
    }
    if (count < 10 || dd <= 0.0 || vv <= 0.0) return std::nullopt;
    return Slope{dv / dd, dv * dv / (dd * vv)};
  }

  static bool left_out_after(std::size_t row, const std::vector<bool>& left_out) {
    return row + 1 < left_out.size() && left_out[row + 1];
  }

  // The nearest ratio within `tolerance`.
  static const Known* known(double ratio, double tolerance) {
    const auto off = [&](const Known& known) { return std::abs(std::abs(ratio) / known.ratio - 1.0); };
    const auto* best = &*std::ranges::min_element(kKnown, {}, off);
    return off(*best) < tolerance ? best : nullptr;
  }

  void judge(const Pair& pair, const Slope& found) {
    const bool far = found.slope < 0.2 || found.slope > 5.0;
    const auto* unit = known(found.slope, far ? 0.15 : 0.03);
    // A gain error of a sensor is for the diagnosis; below 5 only the ratio of two units counts, in clean
    // data.
    if (!far && (unit == nullptr || found.together < kOneRatio)) return;
    const auto text =
        fmt::format("is {:.3g} times the rate of {}: one of the two, or the time, is in another unit{}",
                    found.slope, pair.position,
                    unit != nullptr     ? fmt::format(" ({})", unit->text)
                    : found.slope < 0.0 ? " or has the other sign"
                                        : "");
    add(pair.speed, text, rate_cure(pair, found.slope, unit), is_stated(pair.position, pair.speed));
  }

  // Lines of [columns] after which the two agree, for each column whose unit the file does not state itself.
  std::string rate_cure(const Pair& pair, double ratio, const Known* unit) const {
    const auto *x = places_.column_of(pair.position), *v = places_.column_of(pair.speed);
    if (x == nullptr || v == nullptr) return "correct the scale of one of the two";
    const double sign = ratio < 0.0 ? -1.0 : 1.0, size = unit != nullptr ? unit->ratio : 1.0;
    if (unit == nullptr && ratio > 0.0) return scale_cure(*v) + "; likewise " + mapping_line(*x);
    std::vector<std::string> ways;
    const auto take = [&](const UsedColumn& column, double factor) {
      auto changed = in_other_unit(column, factor);
      ways.push_back(mapping_line(sign < 0.0 ? reversed(changed) : changed));
    };
    const bool doubt_both = x->in_file == v->in_file;
    if (doubt_both || !v->in_file) take(*v, 1.0 / size);
    if (doubt_both || !x->in_file) take(*x, size);
    const auto* time = places_.column_of("t_s");
    if (unit != nullptr && is_of_gear(*unit) && time != nullptr && !time->in_file) take(*time, 1.0 / size);
    return fmt::format("write {} into [columns]{}", fmt::join(ways, ", or "),
                       ways.size() > 1 ? ", whichever is true" : "");
  }

  // The positions of two motors that move alike have the same rate: none of them is exchanged.
  bool fits_its_own_speed(std::string_view position) const {
    const auto* pair = std::ranges::find(kPairs, position, &Pair::position);
    if (pair == kPairs.end() || !recording_.has(pair->speed)) return false;
    const auto own = slope(position, pair->speed);
    return own && own->together > kCorrelates;
  }

  // A speed that is the rate of another channel: the position and that channel are exchanged.
  bool look_for_exchange(const Pair& pair, const Slope& own) {
    if (own.together > kCorrelates && own.slope > 0.2 && own.slope < 5.0) return false;
    const TrialRecording::Channel* best = nullptr;
    Slope most{0.0, std::max(0.9, own.together + 0.1)};
    for (const auto& other : recording_.channels) {
      if (other.name == pair.position || other.name == pair.speed || fits_its_own_speed(other.name)) continue;
      const auto found = slope(other.name, pair.speed);
      if (found && found->together > most.together) best = &other, most = *found;
    }
    if (best == nullptr) return false;
    const auto *x = places_.column_of(pair.position), *other = places_.column_of(best->name);
    std::string cure = "exchange the two columns in [columns]";
    if (x != nullptr && other != nullptr) {
      auto a = *x, b = *other;
      std::swap(a.column, b.column);
      // With these numbers the position has the rate that the speed states.
      a.scale =
          std::abs(most.slope * other->scale / x->scale - 1.0) < 0.2 ? x->scale : most.slope * other->scale;
      a.unit.clear(), b.unit.clear();
      cure = fmt::format("write {} and {} into [columns], with the scales that belong to them",
                         mapping_line(a), mapping_line(b));
    }
    add(pair.position,
        fmt::format("is not what {} is the rate of (correlation {:.2f}); {} is ({:.2f}): the two columns are "
                    "exchanged",
                    pair.speed, std::sqrt(own.together), best->name, std::sqrt(most.together)),
        std::move(cure), is_stated(pair.position, pair.speed));
    return true;
  }

  // The position is the rate of the speed. In a swing the rate of a speed falls as the angle grows, so that a
  // speed that goes against the rate of its position, and the position with the rate of the speed, tells
  // exchanged columns from another unit or sign.
  bool look_for_crossing(const Pair& pair, const Slope& own) {
    constexpr double kGainError = 0.1;  // of a speed; another unit of the position is farther from 1
    if (own.slope > 0.0) return false;
    const auto crossed = slope(pair.speed, pair.position);
    if (!crossed || crossed->together < kOneRatio || std::abs(crossed->slope - 1.0) > kGainError)
      return false;
    const auto *x = places_.column_of(pair.position), *v = places_.column_of(pair.speed);
    std::string cure = "exchange the two columns in [columns]";
    if (x != nullptr && v != nullptr)
      cure = fmt::format("write {} and {} into [columns]", mapping_line(in_place_of(*v, *x)),
                         mapping_line(in_place_of(*x, *v)));
    add(pair.position,
        fmt::format("is the rate of {} (correlation {:.2f}), which goes against the rate of {}: the two "
                    "columns are exchanged",
                    pair.speed, std::sqrt(crossed->together), pair.position),
        std::move(cure), is_stated(pair.position, pair.speed));
    return true;
  }

  // The column as another channel's. With unit and scale both stated the unit in its name does not count.
  static UsedColumn in_place_of(UsedColumn column, const UsedColumn& other) {
    column.channel = other.channel;
    return in_other_unit(std::move(column), 1.0);
  }

  bool is_stated(std::string_view position, std::string_view speed) const {
    return places_.is_stated(position) && places_.is_stated(speed);
  }

  void add(std::string_view channel, std::string what, std::string cure, bool stated) {
    doubt_column(recording_, places_, stated, channel, std::move(what), std::move(cure));
  }

  TrialRecording& recording_;
  const RecordingPlaces& places_;
};

}  // namespace

void check_rates(TrialRecording& recording, const RecordingPlaces& places) {
  if (recording.has_time) RateChecker(recording, places).run();
}

}  // namespace sandhopper
