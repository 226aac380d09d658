#include "tools/calibrate/taps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace sandhopper::calibrate {
namespace {

constexpr double kApart_s = 0.15;
constexpr double kAround_s = 0.015;
constexpr double kGrid_s = 1e-4;

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

// size = |signal - median|. noise = 1.48 median(size), the standard deviation of normal noise; taps are too
// rare to change it.
struct Swings {
  std::vector<double> size;
  double noise;
};
Swings swings_of(const Series& signal) {
  Swings out;
  const double middle = median_of(signal.value);
  for (const double v : signal.value) out.size.push_back(std::abs(v - middle));
  out.noise = 1.48 * median_of(out.size);
  return out;
}

// True if another peak follows the one at `peak` after the signal has come down.
bool strikes_again(const Series& signal, const std::vector<double>& size, std::size_t peak) {
  bool down = false;
  for (std::size_t i = peak; i < size.size() && signal.time_s[i] < signal.time_s[peak] + kApart_s; ++i) {
    down |= size[i] < 0.15 * size[peak];
    if (down && size[i] > size[peak] / 3.0) return true;
  }
  return false;
}

// Value of the series at any time, by a cubic (Catmull-Rom) between neighbouring samples.
std::optional<double> cubic_at(const Series& s, double time_s) {
  const auto next = std::ranges::upper_bound(s.time_s, time_s);
  const auto i = next - s.time_s.begin();
  if (i < 2 || i + 1 >= static_cast<std::ptrdiff_t>(s.size())) return std::nullopt;
  const auto k = static_cast<std::size_t>(i);
  const double width = s.time_s[k] - s.time_s[k - 1];
  const double u = (time_s - s.time_s[k - 1]) / width;
  const double m0 = (s.value[k] - s.value[k - 2]) / (s.time_s[k] - s.time_s[k - 2]) * width;
  const double m1 = (s.value[k + 1] - s.value[k - 1]) / (s.time_s[k + 1] - s.time_s[k - 1]) * width;
  const double u2 = u * u, u3 = u2 * u;
  return (2 * u3 - 3 * u2 + 1) * s.value[k - 1] + (u3 - 2 * u2 + u) * m0 + (3 * u2 - 2 * u3) * s.value[k] +
         (u3 - u2) * m1;
}

struct Match {
  double gain, unexplained;
};
std::optional<Match> match(const Series& reference, const Series& other, double tap_s, double delay_s) {
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0, syy = 0.0;
  const auto from =
      std::ranges::lower_bound(other.time_s, tap_s + delay_s - kAround_s) - other.time_s.begin();
  for (auto i = static_cast<std::size_t>(from);
       i < other.size() && other.time_s[i] < tap_s + delay_s + kAround_s; ++i) {
    const auto x = cubic_at(reference, other.time_s[i] - delay_s);
    if (!x) return std::nullopt;
    const double y = other.value[i];
    n += 1.0, sx += *x, sy += y, sxx += *x * *x, sxy += *x * y, syy += y * y;
  }
  const double xx = sxx - sx * sx / n, xy = sxy - sx * sy / n, yy = syy - sy * sy / n;
  if (n < 6.0 || xx <= 0.0 || yy <= 0.0) return std::nullopt;
  return Match{xy / xx, 1.0 - xy * xy / (xx * yy)};
}

}  // namespace

std::vector<double> find_taps(const Series& signal, const TapLimits& limits, std::vector<Refusal>& refusals) {
  std::vector<double> taps;
  if (signal.size() > 100) {
    const auto [size, noise] = swings_of(signal);
    const double threshold = std::max(8.0 * noise, *std::ranges::max_element(size) / 3.0);
    for (std::size_t i = 0; i < size.size(); ++i) {
      if (size[i] < threshold || (!taps.empty() && signal.time_s[i] < taps.back() + kApart_s)) continue;
      std::size_t peak = i;  // index of the largest of the next 20 ms
      for (std::size_t k = i; k < size.size() && signal.time_s[k] < signal.time_s[i] + 0.02; ++k)
        if (size[k] > size[peak]) peak = k;
      taps.push_back(signal.time_s[peak]);
      if (strikes_again(signal, size, peak))
        refusals.push_back({"double_tap",
                            fmt::format("{}: the tap at {:.2f} s is followed by another at once", limits.what,
                                        signal.time_s[peak]),
                            "tap once, with something hard that does not bounce, and wait half a second"});
    }
  }
  if (taps.size() < limits.fewest)
    refusals.push_back(
        {"too_few_points",
         fmt::format("{} shows {} taps, at least {} are needed", limits.what, taps.size(), limits.fewest),
         "tap harder and more often, half a second apart"});
  return taps;
}

Delay delay_of(const Series& reference, const Series& other, const DelaySearch& search) {
  Delay out;
  const int steps = static_cast<int>(std::ceil(search.search_s / kGrid_s));
  std::vector<double> left(static_cast<std::size_t>(2 * steps + 1), 2.0);
  for (int i = -steps; i <= steps; ++i)
    if (const auto m = match(reference, other, search.tap_s, search.centre_s + i * kGrid_s))
      left[static_cast<std::size_t>(i + steps)] = m->unexplained;
  const auto best = static_cast<std::size_t>(std::ranges::min_element(left) - left.begin());
  if (best == 0 || best + 1 >= left.size() || left[best] > 1.0 || left[best - 1] > 1.0 ||
      left[best + 1] > 1.0)
    return out;
  // Vertex of the parabola through the three best grid points.
  const double bend = left[best - 1] - 2.0 * left[best] + left[best + 1];
  const double shift = bend > 0.0 ? 0.5 * (left[best - 1] - left[best + 1]) / bend : 0.0;
  out.delay_s = search.centre_s + (static_cast<double>(best) - steps + shift) * kGrid_s;
  const auto at = match(reference, other, search.tap_s, out.delay_s);
  if (!at) return out;
  out.gain = at->gain;
  out.unexplained = at->unexplained;
  out.found = true;
  return out;
}

}  // namespace sandhopper::calibrate
