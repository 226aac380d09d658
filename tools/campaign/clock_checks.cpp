#include "tools/campaign/clock_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "tools/campaign/column_rivals.hpp"
#include "tools/campaign/implausible.hpp"
#include "tools/campaign/signal_noise.hpp"
#include "tools/campaign/trial_rows.hpp"

namespace sandhopper {
namespace {

constexpr std::size_t kSide = 4;  // rows on each side of a gap that give a speed
// In rows. In a shorter gap one row's motion and that of the lost rows differ too little beside noise.
constexpr double kLongGap = 10.0;
constexpr double kDrift = 0.01;   // share of the time; see the header
constexpr double kOfNoise = 5.0;  // standard deviations by which a motion is clear
constexpr double kGrowing = 0.9;  // share of rows; a column that rests more often is too coarse to be a time

// Steps of a channel around row `at`: the mean of a row before and after it, and the one across.
struct Crossing {
  double before, across, after;
};

std::optional<Crossing> crossing(std::span<const double> values, std::size_t at) {
  for (std::size_t row = at - kSide - 1; row < at + kSide + 1; ++row)
    if (std::isnan(values[row])) return std::nullopt;
  constexpr auto kRows = static_cast<double>(kSide);
  return Crossing{(values[at - 1] - values[at - 1 - kSide]) / kRows, values[at] - values[at - 1],
                  (values[at + kSide] - values[at]) / kRows};
}

// Longest step of the time in the rows on both sides of row `at`. The rows of a pulse counter come more
// slowly as the wheel does.
double longest_step_beside_s(const std::vector<double>& t_s, std::size_t at) {
  double longest_s = 0.0;
  for (std::size_t row = at - kSide; row <= at + kSide; ++row)
    if (row != at) longest_s = std::max(longest_s, t_s[row] - t_s[row - 1]);
  return longest_s;
}

// The channel moves evenly, its speeds on both sides within 30 %, and across the gap by half to one and a
// half times one row's step. A motion that turns round in between may come back to the same place.
bool goes_on(const Crossing& c) {
  const double step = 0.5 * (c.before + c.after);
  const bool even = c.before * c.after > 0.0 && std::abs(c.before - c.after) < 0.3 * std::abs(step);
  return even && std::abs(c.across - step) < 0.5 * std::abs(step);
}

// Long steps of the time across which a position goes on as from row to row, and all long steps at which it
// moves.
struct TimeBursts {
  std::size_t even = 0, all = 0, first_row = 0;
  double longest_s = 0.0;
};

TimeBursts time_bursts(const TrialRecording& recording, std::span<const double> position) {
  const auto& t = recording.t_s;
  const double long_s = kLongestStep * median_step_s(t);
  const double clear = kOfNoise * noise_of_bends(position);
  TimeBursts bursts;
  for (std::size_t at = 2; at + 1 < t.size(); ++at) {
    const double gap_s = t[at] - t[at - 1];
    const double before = position[at - 1] - position[at - 2], after = position[at + 1] - position[at];
    const double usual = 0.5 * (before + after), across = position[at] - position[at - 1];
    if (gap_s <= long_s || std::isnan(usual + across) || !(std::abs(usual) > clear)) continue;
    ++bursts.all;
    if (std::abs(across - usual) >= 0.5 * std::abs(usual)) continue;
    if (bursts.even++ == 0) bursts.first_row = at;
    bursts.longest_s = std::max(bursts.longest_s, gap_s);
  }
  return bursts;
}

// Seconds from row to row, by least squares of the times over the row's number.
double mean_row_s(const std::vector<double>& t_s) {
  const auto n = static_cast<double>(t_s.size());
  double st = 0.0, sit = 0.0;
  for (std::size_t i = 0; i < t_s.size(); ++i) st += t_s[i], sit += static_cast<double>(i) * t_s[i];
  return 12.0 * (sit - 0.5 * (n - 1.0) * st) / (n * (n * n - 1.0));
}

// Rows that were sampled evenly and got the times at which they arrived, many at once. True if it is noted.
bool doubt_bursts(TrialRecording& recording, const RecordingPlaces& places, std::string_view channel) {
  constexpr std::size_t kFewest = 3;  // one or two may be a stop
  constexpr double kNearlyAll = 0.9;  // of the long steps
  const auto bursts = time_bursts(recording, recording.channel(channel));
  if (bursts.even < kFewest ||
      static_cast<double>(bursts.even) < kNearlyAll * static_cast<double>(bursts.all))
    return false;
  const double row_s = mean_row_s(recording.t_s);
  doubt_column(
      recording, places, places.is_stated("t_s"), "t_s",
      fmt::format(
          "stands nearly still and then grows by up to {:.3g} s, {} times, first in line {}, but {} goes on "
          "there as from row to row: the rows came evenly and have the times at which they arrived in "
          "bursts",
          bursts.longest_s, bursts.even, places.line_of(bursts.first_row), channel),
      fmt::format(
          "take t_s out of [columns] and write [format] row_every_s = {:.6g}, the mean step; better, export "
          "the sensor's own times",
          row_s));
  return true;
}

// True if the other channels make no step across the gap that is large beside their usual ones.
bool others_go_on(const TrialRecording& recording, std::string_view position, std::size_t at) {
  constexpr double kTimes = 3.0;
  return std::ranges::all_of(recording.channels, [&](const auto& channel) {
    if (channel.name == position) return true;
    double largest = 0.0;
    const auto& v = channel.values;
    for (std::size_t row = at - kSide; row < at + kSide; ++row)
      if (row != at) largest = std::fmax(largest, std::abs(v[row] - v[row - 1]));
    const double across = std::abs(v[at] - v[at - 1]);
    return std::isnan(across) || across <= kTimes * largest;
  });
}

}  // namespace

void check_clock_steps(TrialRecording& recording, const RecordingPlaces& places) {
  constexpr std::array<std::string_view, 5> kPositions{"position_rad", "foot_z_m", "height_m",
                                                       "motor_left_position_rad", "motor_right_position_rad"};
  const auto& t = recording.t_s;
  if (!recording.has_time || t.size() < 2 * (kSide + 1)) return;
  for (const auto channel : kPositions)
    if (recording.has(channel) && doubt_bursts(recording, places, channel)) return;
  const double usual_s = median_step_s(t);
  for (std::size_t at = kSide + 1; at + kSide < t.size(); ++at) {
    const double gap_s = t[at] - t[at - 1];
    if (gap_s < kLongGap * std::max(usual_s, longest_step_beside_s(t, at))) continue;
    for (const auto channel : kPositions) {
      if (!recording.has(channel)) continue;
      const auto c = crossing(recording.channel(channel), at);
      if (!c || !goes_on(*c) || !others_go_on(recording, channel, at)) continue;
      return doubt_column(
          recording, places, places.is_stated("t_s"), "t_s",
          fmt::format("grows by {:.6g} s in line {}, but {} goes on by {:.3g} as from row to row, and not by "
                      "{:.3g}: the clock stepped forward",
                      gap_s, places.line_of(at), channel, c->across, c->before * gap_s / usual_s),
          fmt::format(
              "give each part a [[trial]], select = {{ to_line = {} }} and select = {{ from_line = {} "
              "}}; if rows are missing there, state unit and scale of t_s",
              places.line_of(at - 1), places.line_of(at)));
    }
  }
}

void check_other_clocks(TrialRecording& recording, const CsvTable& table, std::size_t time_column,
                        const RecordingPlaces& places) {
  const auto& t = recording.t_s;
  constexpr std::size_t kFewest = 10;
  if (t.size() < kFewest || !(t.back() > t.front())) return;
  const double usual_s = median_step_s(t), span_s = t.back() - t.front();
  for (const auto rival : rivals_of_time(table, time_column)) {
    const auto& other = table.columns[rival];
    if (std::ranges::any_of(other, [](double value) { return std::isnan(value); })) continue;
    std::size_t grows = 0;
    for (std::size_t i = 1; i < other.size(); ++i) grows += other[i] > other[i - 1];
    if (static_cast<double>(grows) < kGrowing * static_cast<double>(other.size() - 1)) continue;
    const auto written = unit_of_column(table, rival);
    const double power = std::round(std::log10(span_s / (other.back() - other.front())));
    const double scale = written && written->is_certain ? written->to_si : std::pow(10.0, power);
    double apart_s = 0.0;
    for (std::size_t i = 0; i < t.size(); ++i)
      apart_s = std::max(apart_s, std::abs(scale * (other[i] - other.front()) - (t[i] - t.front())));
    if (apart_s <= usual_s || apart_s <= kDrift * span_s) continue;
    const auto* own = places.column_of("t_s");
    const double own_power = own == nullptr ? 0.0 : std::round(std::log10(std::abs(own->scale)));
    if (!written && (unit_of_column(table, time_column) || power != own_power)) {
      add_implausible(recording, places, FindingSeverity::note, table.names[rival],
                      fmt::format("is called a time, states no unit and does not go with the column of t_s "
                                  "(taken in {:g} s, {:.3g} s apart): taken for a counter and not used",
                                  scale, apart_s),
                      fmt::format("if it is the clock of another sensor, write its unit behind the name, as "
                                  "in {}, and a check says how to read it",
                                  toml_text(table.names[rival] + " [ms]")));
      continue;
    }
    const UsedColumn second{.channel = "t_s",
                            .column = table.names[rival],
                            .unit = written ? written->text : "s",
                            .scale = scale};
    return doubt_column(
        recording, places, places.is_stated("t_s"), table.names[rival],
        fmt::format("holds other times than the column of t_s, {:.3g} s apart: a row holds samples of "
                    "different instants",
                    apart_s),
        fmt::format(
            "leave in [columns] the channels of one clock, with {}; read the others by also = {{ file "
            "= {}, columns = {{ {}, CHANNEL = \"COLUMN\" }} }}",
            own == nullptr ? "t_s" : mapping_line(*own),
            toml_text(std::filesystem::path(places.file).filename().string()), mapping_line(second)));
  }
}

}  // namespace sandhopper
