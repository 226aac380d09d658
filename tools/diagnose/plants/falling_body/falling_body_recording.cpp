#include "tools/diagnose/plants/falling_body/falling_body_recording.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace sandhopper::diagnose {
namespace {

// Sum of squared residuals of the best straight line through the samples.
double misfit_of_line(const Samples& s) {
  const auto n = static_cast<double>(s.value.size());
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
  for (std::size_t i = 0; i < s.value.size(); ++i) {
    x += s.time_s[i] / n;
    y += s.value[i] / n;
  }
  for (std::size_t i = 0; i < s.value.size(); ++i) {
    xx += std::pow(s.time_s[i] - x, 2);
    xy += (s.time_s[i] - x) * (s.value[i] - y);
    yy += std::pow(s.value[i] - y, 2);
  }
  return yy - (xx > 0.0 ? xy * xy / xx : 0.0);
}

}  // namespace

std::optional<double> release_before_shock_s(const Samples& accels, double g) {
  // Longest duration of a soft release, and the windows before and after it whose mean readings are compared.
  constexpr double kSoft_s = 0.25, kWindow_s = 0.1;
  const auto& a = accels.value;
  const auto& t = accels.time_s;
  const auto mean = [&](double from_s, double to_s) {
    double sum = 0.0, count = 0.0;
    for (auto i = static_cast<std::size_t>(std::lower_bound(t.begin(), t.end(), from_s) - t.begin());
         i < t.size() && t[i] <= to_s; ++i, ++count)
      sum += a[i];
    return count >= 3.0 ? sum / count : std::nan("");
  };
  const auto hardest = static_cast<std::size_t>(std::max_element(a.begin(), a.end()) - a.begin());
  std::optional<double> release_s;
  for (std::size_t i = 1; i < hardest; ++i) {
    if (a[i] >= 0.7 * g || a[i - 1] < 0.7 * g) continue;
    const double start_s = std::max(t.front(), t[i] - kSoft_s - kWindow_s);
    const double before = mean(start_s, std::min(start_s + kWindow_s, t[i - 1]));
    const double after = mean(t[i] + 0.5 * kWindow_s, t[i] + kWindow_s);
    if (std::abs(before - g) < 0.25 * g && after < 0.6 * g) release_s = t[i];
  }
  return release_s;
}

std::optional<double> end_of_rest_s(const Samples& heights, double believed_noise_m, double fall_mps2) {
  if (heights.value.size() < 10) return std::nullopt;
  const double noise = std::max({fluctuation_rms(heights), believed_noise_m, 1e-6});
  std::size_t still = 0;
  double sum = 0.0;
  while (still < heights.value.size()) {
    const double mean = still > 0 ? sum / static_cast<double>(still) : heights.value[0];
    if (std::abs(heights.value[still] - mean) > 4.0 * noise) break;
    sum += heights.value[still++];
  }
  if (still < 5 || still >= heights.value.size()) return std::nullopt;
  // A body that falls from rest is seen to move after this time, when it has fallen by 5 standard deviations.
  const double fall_s = std::sqrt(2.0 * 5.0 * noise / fall_mps2);
  const double still_s = heights.time_s[still] - heights.time_s[0];
  if (still_s <= 2.0 * fall_s + 0.02) return std::nullopt;
  return still_s - fall_s;
}

std::optional<double> landed_after_s(const Samples& heights, double believed_noise_m) {
  constexpr double kStill = 4.0, kShort = 6.0;  // in standard deviations: still heights; fall that is missing
  constexpr std::size_t kBefore = 5;            // samples for the speed before
  const auto& [t, h] = heights;
  const double noise = std::max({fluctuation_rms(heights), believed_noise_m, 1e-6});
  std::size_t first = h.size();
  double sum = 0.0;
  while (first > 0) {
    const auto still = static_cast<double>(h.size() - first);
    if (still > 0.0 && std::abs(h[first - 1] - sum / still) > kStill * noise) break;
    sum += h[--first];
  }
  if (first <= kBefore || h.size() - first < 2) return std::nullopt;
  const double fell_mps = (h[first - 1 - kBefore] - h[first - 1]) / (t[first - 1] - t[first - 1 - kBefore]);
  const double would_fall_m = fell_mps * (t.back() - t[first]);
  if (would_fall_m - (h[first] - h.back()) < kShort * noise) return std::nullopt;
  return t[first - 1];
}

std::optional<double> loss_of_weight_s(const Samples& accels, double gravity_mps2) {
  const auto& [t, a] = accels;
  std::size_t hangs = 0;
  while (hangs < a.size() && std::abs(a[hangs] - gravity_mps2) < 0.25 * gravity_mps2) ++hangs;
  if (hangs < 3 || 2 * hangs > a.size()) return std::nullopt;
  const bool falls = std::all_of(a.begin() + static_cast<std::ptrdiff_t>(hangs),
                                 a.begin() + static_cast<std::ptrdiff_t>(2 * hangs),
                                 [&](double felt) { return felt < 0.5 * gravity_mps2; });
  if (!falls) return std::nullopt;
  return 0.5 * (t[hangs - 1] + t[hangs]);
}

std::optional<double> gap_around_s(const Samples& accels, double about_s) {
  // Distance of the gap from `about_s`; shortest duration of a gap.
  constexpr double kNear_s = 0.03, kLeast_s = 0.01;
  for (std::size_t i = 1; i < accels.time_s.size(); ++i) {
    const double from_s = accels.time_s[i - 1], to_s = accels.time_s[i];
    if (to_s - from_s > kLeast_s && from_s - kNear_s < about_s && about_s < to_s + kNear_s) return from_s;
  }
  return std::nullopt;
}

std::optional<double> release_by_hand_s(const Samples& heights) {
  // Part of the recording that is fitted; step of the tried releases; samples for a fit.
  constexpr double kLook_s = 1.0, kStep_s = 0.01;
  constexpr std::size_t kFewest = 8;
  double best = 1e300, best_s = 0.0;
  for (double release_s = 0.0; release_s <= 0.5 * kLook_s; release_s += kStep_s) {
    Samples fall;  // height over the square of the time since release
    for (std::size_t i = 0; i < heights.value.size() && heights.time_s[i] <= kLook_s; ++i) {
      fall.time_s.push_back(std::pow(std::max(0.0, heights.time_s[i] - release_s), 2));
      fall.value.push_back(heights.value[i]);
    }
    if (fall.value.size() < kFewest) return std::nullopt;
    const double misfit = misfit_of_line(fall);
    if (misfit < best) {
      best = misfit;
      best_s = release_s;
    }
  }
  if (best_s < 2.0 * kStep_s) return std::nullopt;
  return best_s;
}

double jitter_s(const std::vector<double>& sampled_s, double row_s) {
  constexpr double kOften = 0.02;  // share of other intervals above which the sensor has a clock of its own
  if (sampled_s.size() < 10) return 0.0;
  const double usual_s = median_step_s(sampled_s);
  double other = 0.0;  // intervals that are a row longer or shorter; larger differences are gaps
  for (std::size_t i = 1; i < sampled_s.size(); ++i) {
    const double rows = std::abs(sampled_s[i] - sampled_s[i - 1] - usual_s) / row_s;
    other += rows > 0.5 && rows < 1.5;
  }
  return other > kOften * static_cast<double>(sampled_s.size()) ? row_s / std::sqrt(12.0) : 0.0;
}

bool goes_on_below_zero(const Samples& heights, double noise_m) {
  std::vector<double> below;
  std::ranges::copy_if(heights.value, std::back_inserter(below), [&](double h) { return h < -noise_m; });
  if (below.size() < 3) return false;
  const auto half = below.begin() + static_cast<std::ptrdiff_t>(below.size() / 2);
  const auto [low, high] = std::ranges::minmax_element(half, below.end());
  return *high - *low > 2.0 * noise_m;
}

double fastest_mps(const Samples& heights) {
  const auto& [t, h] = heights;
  const std::size_t apart = std::max<std::size_t>(1, h.size() / 10);
  double fastest = 0.0;
  for (std::size_t i = apart; i < h.size(); ++i)
    fastest = std::max(fastest, std::abs(h[i] - h[i - apart]) / (t[i] - t[i - apart]));
  return fastest;
}

std::optional<double> hardest_deceleration_s(const Samples& accels, double g) {
  constexpr double kShareOfPeak = 0.85;
  double most = 0.0;
  for (const double a : accels.value) most = std::max(most, a);
  if (most < 3.0 * g) return std::nullopt;
  for (std::size_t i = 0; i < accels.value.size(); ++i)
    if (accels.value[i] > kShareOfPeak * most) return accels.time_s[i];
  return std::nullopt;
}

std::optional<double> liquid_entry_s(const Samples& accels, double g) {
  constexpr std::size_t kBefore = 20, kAfter = 5;  // samples of the free fall, and above the blow's threshold
  constexpr double kFree = 0.25, kBlow = 0.1;      // in g
  const auto& a = accels.value;
  const double blow = std::max(8.0 * fluctuation_rms(accels), kBlow * g);
  double before = 0.0;  // sum of the last kBefore
  for (std::size_t i = 0; i + kAfter < a.size(); ++i) {
    if (i >= kBefore && std::abs(before) < kFree * g * kBefore) {
      const double level = before / kBefore;
      const auto is_up = [&](double value) { return value - level > blow; };
      if (std::all_of(a.begin() + static_cast<std::ptrdiff_t>(i),
                      a.begin() + static_cast<std::ptrdiff_t>(i + kAfter), is_up)) {
        while (i > 0 && a[i - 1] - level > 0.3 * blow) --i;
        return accels.time_s[i > 0 ? i - 1 : 0];
      }
    }
    before += a[i] - (i >= kBefore ? a[i - kBefore] : 0.0);
  }
  return std::nullopt;
}

std::optional<Impact> find_impact(const Samples& accels, double peak_s, double release_s, double g) {
  // Duration of the steady reading before the impact; share of the peak above it at which the impact begins;
  // time after a soft release from which the body falls freely.
  constexpr double kPlateau_s = 0.4, kBegins = 0.03, kSoftRelease_s = 0.15;
  std::size_t at = 0;
  while (at < accels.value.size() && accels.time_s[at] < peak_s) ++at;
  if (at == 0 || at >= accels.value.size()) return std::nullopt;
  const double peak = accels.value[at];
  std::size_t half = at;
  while (half > 0 && accels.value[half] > 0.5 * peak) --half;
  std::vector<double> plateau;
  for (std::size_t i = 0; i < half; ++i)
    if (accels.time_s[i] > accels.time_s[half] - 1.5 * kPlateau_s &&
        accels.time_s[i] < accels.time_s[half] - 0.5 * kPlateau_s)
      plateau.push_back(accels.value[i]);
  if (plateau.size() < 5) return std::nullopt;
  std::nth_element(plateau.begin(), plateau.begin() + static_cast<std::ptrdiff_t>(plateau.size() / 2),
                   plateau.end());
  const double level = plateau[plateau.size() / 2];
  const Smoothed smoothed = smooth(accels, 2);
  std::size_t onset = half;
  while (onset > 0 && smoothed.value[onset] > level + kBegins * (peak - level)) --onset;
  const auto speed_mps = [&](double at_s) {
    double sum = 0.0;
    for (std::size_t i = 1; i < accels.time_s.size() && accels.time_s[i] <= at_s; ++i)
      if (accels.time_s[i] > release_s - kPlateau_s)
        sum += (accels.value[i] - g) * (accels.time_s[i] - accels.time_s[i - 1]);
    return sum;
  };
  const double impact_s = accels.time_s[onset];
  const double fall_from_s = release_s + kSoftRelease_s;
  return Impact{impact_s, speed_mps(impact_s), fall_from_s, speed_mps(fall_from_s)};
}

}  // namespace sandhopper::diagnose
