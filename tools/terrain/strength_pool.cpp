#include "tools/terrain/strength_pool.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "terrain/none.hpp"
#include "terrain/trial_statistics.hpp"

namespace sandhopper {
namespace {

constexpr double kSecantDepth_m = 0.020;

double shared_sd(std::span<const StrengthCurve> curves) {
  double shared = 0.0;
  for (const auto& curve : curves) shared = std::max(shared, curve.shared_sd_relative);
  return shared;
}

// Pools the trials' values at one depth. They are independent, because each trial's force belongs to its own
// draw of the bed.
template <class Value>
PooledValue pooled(std::span<const StrengthCurve> curves, Value&& value, double shared_sd_relative) {
  std::vector<TrialValue> values;
  for (const auto& curve : curves) values.push_back(value(curve));
  return pool_trials(values, shared_sd_relative);
}

// Dry ground cannot pull, so intervals of the force are limited to zero from below.
void keep_positive(PooledValue& force_N) {
  if (std::isfinite(force_N.mean_low)) force_N.mean_low = std::max(force_N.mean_low, 0.0);
  if (std::isfinite(force_N.new_low)) force_N.new_low = std::max(force_N.new_low, 0.0);
}

std::vector<PooledDepth> pool_depths(std::span<const StrengthCurve> curves, bool tangents) {
  double cell_m = 0.0, deepest_m = 0.0;
  for (const auto& curve : curves) {
    cell_m = std::max(cell_m, curve.cell_m);
    deepest_m = std::max(deepest_m, curve.to_m);
  }
  const double shared = shared_sd(curves);
  std::vector<PooledDepth> depths;
  for (double depth_m = 0.5 * cell_m; depth_m <= deepest_m; depth_m += 0.5 * cell_m) {
    PooledDepth point{.depth_m = depth_m};
    point.force_N = pooled(
        curves, [&](const auto& c) { return c.force_at(depth_m); }, shared);
    if (point.force_N.trials == 0) continue;
    keep_positive(point.force_N);
    if (tangents)
      point.tangent_N_per_m = pooled(
          curves, [&](const auto& c) { return c.tangent_at(depth_m); }, shared);
    depths.push_back(point);
  }
  return depths;
}

TrialValue slope_between(const StrengthCurve& curve, double from_m, double to_m) {
  const auto low = curve.force_at(from_m), high = curve.force_at(to_m);
  return {(high.value - low.value) / (to_m - from_m), 0.0};
}

void pool_numbers(CurveGroup& group) {
  const double shared = shared_sd(group.curves);
  for (const auto& curve : group.curves) group.slope_from_m = std::max(group.slope_from_m, curve.from_m);
  group.slope_to_m = group.deepest_all_m();
  const bool common = group.slope_to_m > group.slope_from_m + group.curves.front().cell_m;
  group.slope_N_per_m = pooled(
      group.curves,
      [&](const auto& c) {
        return common ? slope_between(c, group.slope_from_m, group.slope_to_m) : TrialValue{kNone};
      },
      shared);
  group.line_N_per_m = pooled(
      group.curves, [](const auto& c) { return c.line_N_per_m; }, shared);
  group.exponent = pooled(
      group.curves, [](const auto& c) { return c.exponent; }, 0.0);
  group.secant_20mm_N_per_m = pooled(
      group.curves,
      [](const auto& c) {
        const auto force = c.force_at(kSecantDepth_m);
        return TrialValue{force.value / kSecantDepth_m, force.sd / kSecantDepth_m};
      },
      shared);
}

// Compares each trial with the band of the others. This needs three trials, and the time grows with the
// square of their number.
void leave_out(CurveGroup& group) {
  constexpr std::size_t kFewest = 3, kMost = 30;
  if (group.curves.size() < kFewest || group.curves.size() > kMost) return;
  for (std::size_t i = 0; i < group.curves.size(); ++i) {
    auto others = group.curves;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    group.left_out.push_back(in_band(group.curves[i], pool_depths(others, false)));
  }
}

double bound_of(std::span<const StrengthCurve> curves) {
  std::vector<double> bounds;
  for (const auto& curve : curves) bounds.push_back(curve.at_least_N_per_m());
  return bounds.size() > 1 ? std::max(mean_over_trials(bounds).ci95_low, 0.0) : bounds.front();
}

}  // namespace

double CurveInBand::share() const {
  return depths > 0 ? static_cast<double>(inside) / static_cast<double>(depths) : kNone;
}

const PooledDepth* CurveGroup::at(double depth_m) const {
  const PooledDepth* nearest = nullptr;
  for (const auto& point : depths)
    if (nearest == nullptr || std::abs(point.depth_m - depth_m) < std::abs(nearest->depth_m - depth_m))
      nearest = &point;
  const bool inside =
      nearest != nullptr && std::abs(nearest->depth_m - depth_m) <= 0.26 * curves.front().cell_m;
  return inside ? nearest : nullptr;
}

double CurveGroup::deepest_all_m() const {
  double deepest_m = std::numeric_limits<double>::infinity();
  for (const auto& curve : curves) deepest_m = std::min(deepest_m, curve.to_m);
  return deepest_m;
}

std::vector<CurveGroup> pool_curves(std::span<const StrengthCurve> curves) {
  std::vector<CurveGroup> groups;
  for (const auto& curve : curves) {
    if (curve.held_out) continue;
    const auto same = std::ranges::find_if(groups, [&](const CurveGroup& group) {
      return group.source == curve.source && std::abs(group.diameter_m - curve.diameter_m) < 1e-6;
    });
    if (same != groups.end())
      same->curves.push_back(curve);
    else
      groups.push_back({.source = curve.source, .diameter_m = curve.diameter_m, .curves = {curve}});
  }
  for (auto& group : groups) {
    group.depths = pool_depths(group.curves, true);
    if (group.depths.empty()) {
      group.at_least_N_per_m = bound_of(group.curves);
      continue;
    }
    pool_numbers(group);
    leave_out(group);
  }
  return groups;
}

std::vector<PooledDepth> scaled(const CurveGroup& group, const DepthRatio& ratio) {
  std::vector<PooledDepth> band = group.depths;
  for (auto& point : band) {
    const double factor = ratio(point.depth_m);
    for (PooledValue* pooled : {&point.force_N, &point.tangent_N_per_m})
      for (double* value : {&pooled->value, &pooled->mean_low, &pooled->mean_high, &pooled->new_low,
                            &pooled->new_high, &pooled->between_sd})
        *value *= factor;
  }
  return band;
}

CurveInBand in_band(const StrengthCurve& curve, std::span<const PooledDepth> band) {
  constexpr double kNormal975 = 1.959964;
  CurveInBand out{.trial = curve.trial};
  for (const auto& point : band) {
    const auto force = curve.force_at(point.depth_m);
    if (std::isnan(force.value) || !std::isfinite(point.force_N.new_high)) continue;
    ++out.depths;
    const auto& f = point.force_N;
    const double half_N = force.value > f.value ? f.new_high - f.value : f.value - f.new_low;
    out.inside += std::abs(force.value - f.value) <= std::hypot(half_N, kNormal975 * force.sd);
    out.force_ratio += force.value / f.value;
    out.half_width += 0.5 * (f.new_high - f.new_low) / f.value;
  }
  const double count = out.depths > 0 ? static_cast<double>(out.depths) : kNone;
  out.force_ratio /= count;
  out.half_width /= count;
  return out;
}

}  // namespace sandhopper
