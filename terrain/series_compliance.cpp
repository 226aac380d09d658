#include "terrain/series_compliance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "terrain/none.hpp"

namespace sandhopper {
namespace {

std::size_t place_of_greatest(std::span<const double> force_N) {
  return static_cast<std::size_t>(std::max_element(force_N.begin(), force_N.end()) - force_N.begin());
}

}  // namespace

LoadingCompliance loading_compliance(const ForcePath& path, double contact_force_N) {
  LoadingCompliance none{kNone, kNone, kNone, kNone};
  if (path.force_N.empty()) return none;
  const auto peak = place_of_greatest(path.force_N);
  auto first = peak;
  while (first > 0 && path.force_N[first - 1] > contact_force_N) --first;
  const double greatest_N = path.force_N[peak];
  double n = 0.0, sf = 0.0, sd = 0.0;
  const auto loaded = [&](std::size_t i) { return path.force_N[i] >= 0.25 * greatest_N; };
  for (auto i = first; i <= peak; ++i)
    if (loaded(i)) {
      n += 1.0;
      sf += path.force_N[i];
      sd += path.displacement_m[i];
    }
  if (n < 5.0) return none;
  const double mean_f = sf / n, mean_d = sd / n;
  double ff = 0.0, fd = 0.0, dd = 0.0;
  for (auto i = first; i <= peak; ++i)
    if (loaded(i)) {
      const double f = path.force_N[i] - mean_f, d = path.displacement_m[i] - mean_d;
      ff += f * f;
      fd += f * d;
      dd += d * d;
    }
  if (!(ff > 0.0)) return none;
  const double slope = fd / ff;
  return {.compliance_m_per_N = slope,
          .toe_m = mean_d - slope * mean_f - path.displacement_m[first],
          .rms_m = std::sqrt(std::max(dd - slope * fd, 0.0) / n),
          .greatest_force_N = greatest_N};
}

Unloading unloading(const ForcePath& path, double resolution_m) {
  if (path.force_N.empty()) return {kNone, kNone, kNone};
  const auto peak = place_of_greatest(path.force_N);
  const auto after = path.force_N.subspan(peak);
  const auto lowest =
      peak + static_cast<std::size_t>(std::min_element(after.begin(), after.end()) - after.begin());
  const double drop_N = path.force_N[peak] - path.force_N[lowest];
  if (drop_N < 0.5 * path.force_N[peak]) return {kNone, kNone, kNone};
  const auto moved = path.displacement_m.subspan(peak, lowest - peak + 1);
  const double recovery_m = *std::max_element(moved.begin(), moved.end()) - path.displacement_m[lowest];
  return {drop_N / std::max(recovery_m, resolution_m), drop_N, recovery_m};
}

}  // namespace sandhopper
