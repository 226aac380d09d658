#include "terrain/ground_events.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "terrain/normal_test.hpp"

namespace sandhopper {
namespace {

struct Point {
  double depth_m, force_N, inertia_N, friction, time_s, speed_mps, samples;
};

std::vector<Point> points_of(const DepthBins& bins) {
  std::vector<Point> points;
  for (const auto& b : bins.bin) {
    if (b.samples == 0.0F) continue;
    const double n = b.samples;
    points.push_back({.depth_m = b.depth_m / n,
                      .force_N = b.force_N / n,
                      .inertia_N = b.inertia_N / n,
                      .friction = b.friction / n,
                      .time_s = b.time_s / n,
                      .speed_mps = b.speed_mps / n,
                      .samples = n});
  }
  return points;
}

constexpr int kSmoothTerms = 8;
constexpr double kDiffuse = 100.0;  // prior standard deviation of X b over the greatest force: says nothing
constexpr std::size_t kLeastPoints = kSmoothTerms + 4;

double greatest_force_N(std::span<const Point> points) {
  double greatest = 0.0;
  for (const auto& p : points) greatest = std::max(greatest, std::abs(p.force_N));
  return greatest;
}

struct Smoothness {
  double length_m;
  double relative;
};

NormalTest smooth_bed(std::span<const Point> points, const GroundEventConfig& config,
                      const Smoothness& smooth) {
  const auto& noise = config.noise;
  const double scale_N = std::max(greatest_force_N(points), noise.force_noise_N);
  const double deepest_m = points.back().depth_m;
  NormalTest test(points.size(), kSmoothTerms);
  for (std::size_t i = 0; i < points.size(); ++i) test.observe(i, points[i].force_N);
  test.add_covariance([&](std::size_t i, std::size_t j) {
    const double apart_m = std::abs(points[i].depth_m - points[j].depth_m);
    const double u = apart_m / smooth.length_m;
    const double s_N = smooth.relative * scale_N;
    const double share = std::max(0.0, 1.0 - apart_m / noise.fluctuation_length_m);
    const double e2 = noise.fluctuation_relative * noise.fluctuation_relative;
    return s_N * s_N * std::exp(-0.5 * u * u) + e2 * points[i].force_N * points[j].force_N * share +
           (i == j ? noise.force_noise_N * noise.force_noise_N / points[i].samples : 0.0);
  });
  const auto term = [&](double sd, auto&& value) {
    test.add_term(sd, [&](std::size_t i) { return value(points[i]); });
  };
  const double wide_N = kDiffuse * scale_N;
  term(wide_N, [](const Point&) { return 1.0; });
  term(wide_N, [&](const Point& p) { return p.depth_m / deepest_m; });
  term(wide_N, [&](const Point& p) { return p.depth_m * p.depth_m / (deepest_m * deepest_m); });
  term(wide_N, [&](const Point& p) { return 1.0 - std::exp(-p.depth_m / noise.intercept_growth_depth_m); });
  term(noise.added_mass_factor + noise.added_mass_factor_sd, [](const Point& p) { return p.inertia_N; });
  term(noise.joint_friction_sd_N, [](const Point& p) { return p.friction; });
  term(scale_N / deepest_m * noise.depth_drift_sd_mps, [](const Point& p) { return p.time_s; });
  return test;
}

// The best of many templates.
class Search {
 public:
  Search(const NormalTest& test, std::span<const Point> points)
      : test_(test), points_(points), shape_(points.size()) {}

  template <class Shape>
  void offer(double place_m, GroundEventKind kind, bool either_sign, const Shape& shape) {
    for (std::size_t i = 0; i < points_.size(); ++i) shape_[i] = shape(points_[i].depth_m);
    const auto found = test_.test(shape_);
    ++templates_;
    if (!either_sign && found.size <= 0.0) return;
    if (found.statistic <= best_.statistic) return;
    best_ = {.kind = kind,
             .depth_m = place_m,
             .size = found.size,
             .size_sd = found.size_sd,
             .statistic = found.statistic};
    best_shape_ = shape_;
  }

  // The best one where it exceeds the threshold; else one of no kind.
  GroundEvent event(double false_alarm_probability, bool either_sign) const {
    GroundEvent event = best_;
    const double sides = either_sign ? 1.0 : 2.0;
    event.threshold =
        chi_squared_1_quantile(std::min(1.0, sides * false_alarm_probability / std::max(1, templates_)));
    if (event.statistic <= event.threshold) event.kind = GroundEventKind::none;
    const auto nearest = std::ranges::min_element(
        points_, {}, [&](const Point& p) { return std::abs(p.depth_m - event.depth_m); });
    event.force_N = nearest->force_N;
    event.speed_mps = nearest->speed_mps;
    return event;
  }
  std::span<const double> best_shape() const { return best_shape_; }

 private:
  const NormalTest& test_;
  std::span<const Point> points_;
  std::vector<double> shape_, best_shape_;
  GroundEvent best_{};
  int templates_ = 0;
};

constexpr double kPlaces_m = 1e-3;  // apart

GroundEvent find_rupture(std::span<const Point> points, const GroundEventConfig& config,
                         std::vector<double>& shape) {
  const auto test =
      smooth_bed(points, config, {config.rupture_smooth_length_m, config.rupture_smooth_relative});
  Search search(test, points);
  for (const auto& p : points) {
    const double place_m = p.depth_m;
    for (const double rise_m : {0.001, 0.002, 0.004})
      for (const double decay_m : {0.0005, 0.0015})
        search.offer(place_m, GroundEventKind::crust_rupture, false, [&](double z) {
          return z <= place_m ? std::max(0.0, 1.0 - (place_m - z) / rise_m)
                              : std::exp(-(z - place_m) / decay_m);
        });
  }
  const auto event = search.event(config.false_alarm_probability, false);
  if (event.kind != GroundEventKind::none)
    shape.assign(search.best_shape().begin(), search.best_shape().end());
  return event;
}

GroundEvent find_boundary(std::span<const Point> points, const GroundEventConfig& config,
                          std::span<const double> rupture_shape) {
  auto test = smooth_bed(points, config, {config.smooth_length_m, config.smooth_relative});
  if (!rupture_shape.empty())
    test.add_term(kDiffuse * greatest_force_N(points), [&](std::size_t i) { return rupture_shape[i]; });
  Search search(test, points);
  const double deepest_m = points.back().depth_m;
  for (double place_m = 0.003; place_m < deepest_m; place_m += kPlaces_m) {
    for (const double width_m : {0.001, 0.002, 0.004})
      search.offer(place_m, GroundEventKind::layer_boundary, true,
                   [&](double z) { return z / (1.0 + std::exp((place_m - z) / width_m)); });
    search.offer(place_m, GroundEventKind::box_floor, true,
                 [&](double z) { return std::max(0.0, z - place_m); });
  }
  return search.event(config.false_alarm_probability, true);
}

// From the first depth at which the foot no longer bears a load upwards.
GroundEvent find_suction(const DepthBins& up, const GroundEventConfig& config) {
  auto points = points_of(up);
  const double free_N = 2.0 * config.noise.force_noise_N;
  const auto loaded =
      std::find_if(points.rbegin(), points.rend(), [&](const Point& p) { return p.force_N < free_N; });
  points.erase(loaded.base(), points.end());
  if (points.size() < 8) return {};
  const double noise2 = config.noise.force_noise_N * config.noise.force_noise_N;
  NormalTest test(points.size(), 2);
  for (std::size_t i = 0; i < points.size(); ++i) test.observe(i, points[i].force_N);
  test.add_covariance(
      [&](std::size_t i, std::size_t j) { return i == j ? noise2 / points[i].samples : 0.0; });
  test.add_term(config.offset_sd_N, [](std::size_t) { return 1.0; });
  test.add_term(config.noise.joint_friction_sd_N, [&](std::size_t i) { return points[i].friction; });
  Search search(test, points);
  const double top_m = points.back().depth_m;
  for (double floor_m = top_m + 0.002; floor_m > top_m - 0.004; floor_m -= kPlaces_m)
    for (const double length_m : {0.003, 0.006, 0.012})
      search.offer(floor_m - length_m / 3.0, GroundEventKind::suction, false, [&](double z) {
        const double u = (floor_m - z) / length_m;
        return u > 0.0 && u < 1.0 ? -6.75 * u * (1.0 - u) * (1.0 - u) : 0.0;
      });
  return search.event(config.false_alarm_probability, false);
}

void put(DepthBins& bins, const JointSample& s, double inertia_N, double friction) noexcept {
  const double place = s.depth_m / DepthBins::kWidth_m;
  if (!(place >= 0.0) || place >= static_cast<double>(DepthBins::kBins)) {
    ++bins.out_of_range;
    return;
  }
  auto& b = bins.bin[static_cast<std::size_t>(place)];
  b.samples += 1.0F;
  b.depth_m += static_cast<float>(s.depth_m);
  b.force_N += static_cast<float>(s.force_N);
  b.inertia_N += static_cast<float>(inertia_N);
  b.friction += static_cast<float>(friction);
  b.time_s += static_cast<float>(s.since_contact_s);
  b.speed_mps += static_cast<float>(s.speed_mps);
}

}  // namespace

GroundEventRecorder::GroundEventRecorder(const GroundEventConfig& config, double foot_radius_m)
    : config_(config), cone_(BedParameters{}, foot_radius_m) {}

void GroundEventRecorder::restart(double crater_depth_m) noexcept {
  sums_ = {};
  sums_.crater_depth_m = static_cast<float>(crater_depth_m);
  sums_.deepest_m = sums_.crater_depth_m;
}

void GroundEventRecorder::add(const JointSample& s) noexcept {
  const double friction = std::tanh(s.leg_rate_mps / config_.noise.friction_switch_speed_mps);
  if (s.depth_m > static_cast<double>(sums_.deepest_m)) {
    sums_.deepest_m = static_cast<float>(s.depth_m);
    if (s.speed_mps < config_.min_speed_mps) return;
    const double inertia_N = cone_.added_mass_gradient_kg_per_m(s.depth_m) * s.speed_mps * s.speed_mps +
                             cone_.added_mass_kg(s.depth_m) * s.accel_mps2;
    put(sums_.down, s, inertia_N, friction);
  } else if (s.speed_mps < -config_.min_speed_mps) {
    put(sums_.up, s, 0.0, friction);
  }
}

GroundEvents find_ground_events(const GroundEventSums& sums, const GroundEventConfig& config) {
  GroundEvents events;
  events.suction = find_suction(sums.up, config);
  const auto points = points_of(sums.down);
  if (points.size() < kLeastPoints) return events;
  std::vector<double> rupture_shape;
  events.rupture = find_rupture(points, config, rupture_shape);
  events.boundary = find_boundary(points, config, rupture_shape);
  return events;
}

double chi_squared_1_quantile(double probability) noexcept {
  double low = 0.0, high = 40.0;  // of the normal deviate
  for (int i = 0; i < 80; ++i) {
    const double middle = 0.5 * (low + high);
    (std::erfc(middle / std::sqrt(2.0)) > probability ? low : high) = middle;
  }
  return low * low;
}

}  // namespace sandhopper
