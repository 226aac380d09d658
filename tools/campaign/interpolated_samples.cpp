#include "tools/campaign/interpolated_samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tools/campaign/sample_times.hpp"

namespace sandhopper {
namespace {

// Rows of a channel that have a sample.
struct GridSamples {
  GridSamples(const std::vector<double>& channel, const UsedColumn* column) {
    for (std::size_t row = 0; row < channel.size(); ++row)
      if (!std::isnan(channel[row])) rows.push_back(row), values.push_back(channel[row]);
    digit = written_digit(values, column);
  }

  double bend(std::size_t i) const { return values[i + 1] - 2.0 * values[i] + values[i - 1]; }

  std::vector<std::size_t> rows;
  std::vector<double> values;
  double digit = 0.0;
};

// Knots: samples at which the line bends by more than its digits. Three rounded values of one straight line
// have a second difference of up to 1/2 + 2/2 + 1/2 digits.
std::vector<std::size_t> knots_of(const GridSamples& samples) {
  constexpr double kRounded = 2.0;
  const double most = (kRounded + 0.01) * samples.digit;
  std::vector<std::size_t> knots;
  for (std::size_t i = 1; i + 1 < samples.values.size(); ++i)
    if (std::abs(samples.bend(i)) > most) knots.push_back(i);
  return knots;
}

// The rows between two knots; 0 if the knots stand irregularly. In a stretch at rest knots may be missing, so
// all that is asked is that none stands off the grid.
std::size_t grid_of(const std::vector<std::size_t>& knots) {
  constexpr double kByChance = 1e-6;
  if (knots.size() < 4) return 0;
  std::vector<std::size_t> gaps;
  for (std::size_t i = 1; i < knots.size(); ++i) gaps.push_back(knots[i] - knots[i - 1]);
  const std::size_t least = *std::ranges::min_element(gaps);
  const auto on_grid = [&](std::size_t gap) { return gap % least == 0; };
  if (least < 2 || !std::ranges::all_of(gaps, on_grid)) return 0;
  const auto by_chance = std::pow(static_cast<double>(least), -static_cast<double>(gaps.size()));
  const auto usual = std::ranges::count(gaps, least);
  return by_chance < kByChance && 2 * usual >= std::ssize(gaps) ? least : 0;
}

// The distance of knots that fall between two rows: there the line bends in one or two rows, and the
// stretches between are equally long, or longer by one. 0 if they are not. For a random signal such a length
// of three or more has a probability below 0.19, the largest value of p^3 (1 - p^2).
double uneven_grid_of(const std::vector<std::size_t>& knots) {
  constexpr std::size_t kShortest = 3, kFewest = 9;  // 0.19^9 < 1e-6
  std::vector<std::size_t> starts, straight;
  for (std::size_t i = 0; i < knots.size(); ++i) {
    const bool follows = i > 0 && knots[i] == knots[i - 1] + 1;
    if (follows && i > 1 && knots[i] == knots[i - 2] + 2) return 0.0;
    if (follows) continue;
    if (i > 0) straight.push_back(knots[i] - knots[i - 1] - 1);
    starts.push_back(knots[i]);
  }
  if (straight.size() < kFewest) return 0.0;
  const auto least = *std::ranges::min_element(straight);
  const auto alike = std::ranges::count_if(straight, [&](std::size_t n) { return n <= least + 1; });
  // In a rest knots are missing.
  const bool others_rest =
      std::ranges::all_of(straight, [&](std::size_t n) { return n <= least + 1 || n >= 2 * least; });
  if (least < kShortest || !others_rest || 2 * alike < std::ssize(straight) ||
      alike < static_cast<std::ptrdiff_t>(kFewest))
    return 0.0;
  double sum = 0.0;
  for (std::size_t i = 1; i < starts.size(); ++i)
    if (straight[i - 1] <= least + 1) sum += static_cast<double>(starts[i] - starts[i - 1]);
  return sum / static_cast<double>(alike);
}

// A motion at one speed to and fro (a triangle, ramps with rests) bends by the same amount at every knot, and
// its slopes lie at most two bends apart. A bend between two rows is split over both. Held values and encoder
// steps jump there and back: their sum is zero.
bool is_at_one_speed(const GridSamples& samples, const std::vector<std::size_t>& knots) {
  // A second difference of three rounded values is off by up to two digits, the sum of two by four.
  constexpr double kRounded = 4.0, kRoundedSplit = 8.0, kSlopes = 2.5;
  double least = std::numeric_limits<double>::infinity(), most = 0.0, rounded = kRounded;
  for (std::size_t i = 0; i < knots.size();) {
    const bool is_split = i + 1 < knots.size() && knots[i + 1] == knots[i] + 1;
    if (is_split) rounded = kRoundedSplit;
    const double bend = samples.bend(knots[i]) + (is_split ? samples.bend(knots[i + 1]) : 0.0);
    least = std::min(least, std::abs(bend)), most = std::max(most, std::abs(bend));
    i += is_split ? 2 : 1;
  }
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;  // steps from row to row
  for (std::size_t i = 1; i < samples.values.size(); ++i) {
    const double step = samples.values[i] - samples.values[i - 1];
    lowest = std::min(lowest, step), highest = std::max(highest, step);
  }
  const bool is_held = most <= rounded * samples.digit;
  return most - least <= rounded * samples.digit && (is_held || highest - lowest <= kSlopes * most);
}

// Rows of the true samples: the knots' grid, or the first row of each bend.
std::vector<bool> rows_to_keep(const std::vector<std::size_t>& knots, std::size_t grid, std::size_t count) {
  std::vector<bool> keep(count, false);
  if (grid > 0)
    for (std::size_t i = knots.front() % grid; i < count; i += grid) keep[i] = true;
  else
    for (std::size_t i = 0; i < knots.size(); ++i) keep[knots[i]] = i == 0 || knots[i] != knots[i - 1] + 1;
  return keep;
}

}  // namespace

double written_digit(const std::vector<double>& values, const UsedColumn* column) {
  constexpr int kMostDecimals = 9;  // more are those of a double, not of a sensor
  const double scale = column == nullptr ? 1.0 : column->scale,
               offset = column == nullptr ? 0.0 : column->offset;
  double unit = 1.0;
  for (int decimals = 0; decimals < kMostDecimals; ++decimals, unit *= 10.0) {
    const bool all = std::ranges::all_of(values, [&](double value) {
      if (std::isnan(value)) return true;
      const double written = unit * (value - offset) / scale;
      return std::abs(written - std::round(written)) < 1e-6 + 1e-9 * std::abs(written);
    });
    if (all) break;
  }
  return std::abs(scale) / unit;
}

void check_interpolated(TrialRecording& recording, const RecordingPlaces& places) {
  if (!recording.has_time) return;
  for (auto& channel : recording.channels) {
    const GridSamples samples(channel.values, places.column_of(channel.name));
    if (holds_in_truth(channel.name)) continue;
    const auto knots = knots_of(samples);
    const std::size_t grid = grid_of(knots);
    const double distance = grid > 0 ? static_cast<double>(grid) : uneven_grid_of(knots);
    if (!(distance > 0.0) || is_at_one_speed(samples, knots)) continue;
    const std::size_t n = samples.rows.size();
    const double row_s = (recording.t_s[samples.rows.back()] - recording.t_s[samples.rows.front()]) /
                         static_cast<double>(n - 1);
    recording.findings.push_back(
        {FindingKind::held_samples, FindingSeverity::note, places.file,
         places.line_of(samples.rows[knots.front()]), 1, channel.name,
         fmt::format(
             "bends only every {:.3g} rows and is straight between: it was sampled every {} ({:.3g} Hz) "
             "and filled up by straight lines; the rows between are taken for no samples, and what "
             "changes faster than {:.3g} Hz does not show",
             distance, duration(distance * row_s), 1.0 / (distance * row_s), 0.5 / (distance * row_s)),
         "export the sensor's own samples, or leave the cell empty where there is no sample"});
    const auto keep = rows_to_keep(knots, grid, n);
    for (std::size_t i = 0; i < n; ++i)
      if (!keep[i]) channel.values[samples.rows[i]] = std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace sandhopper
