#include "tools/campaign/column_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace sandhopper {
namespace {

// Limits of 16, 24 and 32 bit integers, and fill values of meteorology, well logging (LAS), netCDF and C.
constexpr std::array kFills{999.0,        9999.0,       99999.0,      999999.0,  999.25,    999.9,
                            32767.0,      32768.0,      65535.0,      8388607.0, 8388608.0, 16777215.0,
                            2147483647.0, 2147483648.0, 4294967295.0, 1e20,      1e30,      9.96921e36};

bool is_fill(double magnitude) {
  return std::ranges::any_of(kFills, [&](double fill) { return std::abs(magnitude / fill - 1.0) < 1e-6; });
}

bool is_whole(double value) { return value == std::floor(value); }

}  // namespace

std::optional<FillValue> fill_value_in(const std::vector<double>& values) {
  FillValue found;
  double rest = 0.0;
  std::size_t samples = 0;
  for (const double value : values)
    if (!std::isnan(value) && is_fill(std::abs(value)) && std::abs(value) > std::abs(found.value))
      found.value = value;
  if (found.value == 0.0) return std::nullopt;
  for (std::size_t row = 0; row < values.size(); ++row) {
    if (std::isnan(values[row])) continue;
    ++samples;
    if (values[row] != found.value) {
      rest = std::max(rest, std::abs(values[row]));
    } else if (found.rows++ == 0) {
      found.first_row = row;
    }
  }
  const bool is_apart = 3.0 * rest < std::abs(found.value) && 2 * found.rows < samples;
  return is_apart ? std::optional(found) : std::nullopt;
}

std::optional<TimeDoubt> doubt_time(const std::vector<double>& times, const std::string& column) {
  constexpr std::size_t kFewest = 10;
  if (times.size() < kFewest) return std::nullopt;
  const double first = times.front(), span = times.back() - first;
  const double step = span / static_cast<double>(times.size() - 1);
  const auto in_unit = [&](std::string_view unit) {
    return fmt::format("t_s = {{ column = \"{}\", unit = \"{}\" }}", column, unit);
  };
  const bool is_epoch = std::abs(first) > 0.5e9 && std::abs(first) < 6e9;  // s since 1970 or 1904
  if (std::ranges::all_of(times, is_whole) && step > 1.0 && !is_epoch)
    return TimeDoubt{
        fmt::format("holds whole numbers, {:.4g} from row to row, and no unit is stated: s, ms, us, or "
                    "the number of a row?",
                    step),
        fmt::format("say which in [columns]: {}", in_unit("ms"))};
  // A day has 86,400 s, so the rows of a logger are less than 1e-4 days apart.
  struct Origin {
    double from, to;
    std::string_view who;
  };
  constexpr std::array kOrigins{Origin{36500.0, 73000.0, "a spreadsheet"}, Origin{7.2e5, 7.7e5, "MATLAB"}};
  for (const auto& origin : kOrigins)
    if (first > origin.from && first < origin.to && step > 0.0 && step < 1e-4)
      return TimeDoubt{
          fmt::format("begins at {:.9g} and grows by {:.3g} from row to row: days as {} counts them?", first,
                      step, origin.who),
          fmt::format("if so write t_s = {{ column = \"{}\", unit = \"d\", scale = 86400.0 }} into "
                      "[columns], else {}",
                      column, in_unit("s"))};
  return std::nullopt;
}

std::size_t put_turns_back(std::vector<double>& angle_rad) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  double low = INFINITY, high = -INFINITY;
  for (const double value : angle_rad)
    if (!std::isnan(value)) low = std::min(low, value), high = std::max(high, value);
  if (!(high - low < 1.001 * kTurn) || high - low < 0.9 * kTurn) return 0;
  std::size_t steps = 0;
  double turns = 0.0, last = NAN;
  for (double& value : angle_rad) {
    if (std::isnan(value)) continue;
    const double step = value - last;
    last = value;
    if (std::abs(step) > 0.5 * kTurn) turns -= std::copysign(kTurn, step), ++steps;
    value += turns;
  }
  return steps;
}

CounterSteps put_counter_back(std::vector<double>& values) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < values.size(); ++row)
    if (!std::isnan(values[row])) rows.push_back(row);
  if (rows.size() < 4) return {};
  const auto value = [&](std::size_t k) { return values[rows[k]]; };
  double low = value(0), high = low, largest_step = 0.0;
  for (const auto row : rows) low = std::min(low, values[row]), high = std::max(high, values[row]);
  std::vector<std::size_t> jumps;
  std::vector<double> widths;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const double step = value(k) - value(k - 1);
    if (std::abs(step) <= 0.8 * (high - low)) {
      largest_step = std::max(largest_step, std::abs(step));
      continue;
    }
    if (k < 2 || k + 1 == rows.size()) return {};
    const double before = value(k - 1) - value(k - 2), after = value(k + 1) - value(k);
    if (!(before * step < 0.0 && after * step < 0.0)) return {};
    jumps.push_back(k);
    widths.push_back(std::abs(step) + 0.5 * (std::abs(before) + std::abs(after)));
  }
  if (jumps.size() < 2) return {};
  const auto [least, most] = std::ranges::minmax(widths);
  if (most - least > largest_step || largest_step > 0.25 * least) return {};
  CounterSteps counter{jumps.size(), 0.0};
  for (const double width : widths) counter.width += width / static_cast<double>(widths.size());
  double added = 0.0;
  std::size_t next = 0;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    if (next < jumps.size() && jumps[next] == k) {
      const double step = value(k) + added - value(k - 1);
      added -= std::copysign(counter.width, step);
      ++next;
    }
    values[rows[k]] += added;
  }
  return counter;
}

std::string put_angle_back(std::vector<double>& angle_rad) {
  if (const auto turns = put_turns_back(angle_rad); turns > 0)
    return fmt::format(
        "jumps by a whole turn {} times, as an angle does that is counted within one turn; the "
        "turns are put back",
        turns);
  if (const auto counter = put_counter_back(angle_rad); counter.count > 0)
    return fmt::format(
        "jumps by {:.4g} {} times while it moves on, as a counter does that is full and begins "
        "again; it is taken as going on",
        counter.width, counter.count);
  return "";
}

bool equals_time(const std::vector<double>& values, const std::vector<double>& times) {
  constexpr std::size_t kFewest = 10;
  return values.size() >= kFewest && values.size() == times.size() && values == times;
}

}  // namespace sandhopper
