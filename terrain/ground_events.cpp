#include "terrain/ground_events.hpp"

#include <algorithm>
#include <array>
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
constexpr double kDiffuse = 100.0;  // prior standard deviation of X b relative to the greatest force:
                                    // uninformative
constexpr std::size_t kLeastPoints = kSmoothTerms + 4;

double greatest_force_N(std::span<const Point> points) {
  double greatest = 0.0;
  for (const auto& p : points) greatest = std::max(greatest, std::abs(p.force_N));
  return greatest;
}

// Distribution of the added mass's factor c.
struct AddedMass {
  double mean, sd;
};

AddedMass added_mass_of(const GroundEventSums& sums, const JointConfig& prior,
                        const StrengthProfile& profile) {
  if (!(profile.added_mass_factor_sd > 0.0)) return {prior.added_mass_factor, prior.added_mass_factor_sd};
  const double landing_sd = sums.crater_depth_m > 0.0F ? prior.added_mass_factor_sd : 0.0;
  return {profile.added_mass_factor, std::hypot(profile.added_mass_factor_sd, landing_sd)};
}

struct Stance {
  std::vector<Point> points;
  std::array<GroundEventSums::Resumption, 2> resumed;
  AddedMass added_mass;

  // Force without that of the expected added mass.
  double ground_N(const Point& p) const { return p.force_N - added_mass.mean * p.inertia_N; }
};

struct Smoothness {
  double length_m;
  double relative;
};

// Slope of force over depth from the neighbouring points [N/m].
double slope_at(std::span<const Point> points, std::size_t i) {
  const auto& before = points[i == 0 ? 0 : i - 1];
  const auto& after = points[std::min(i + 1, points.size() - 1)];
  return (after.force_N - before.force_N) / std::max(after.depth_m - before.depth_m, DepthBins::kWidth_m);
}

NormalTest smooth_bed(const Stance& stance, const GroundEventConfig& config, const Smoothness& smooth) {
  const auto& points = stance.points;
  const auto& noise = config.noise;
  const double scale_N = std::max(greatest_force_N(points), noise.force_noise_N);
  const double deepest_m = points.back().depth_m;
  NormalTest test(points.size(), kSmoothTerms);
  std::vector<double> variance(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    test.observe(i, stance.ground_N(points[i]));
    const double from_depth_N = slope_at(points, i) * config.depth_noise_m;
    variance[i] =
        (noise.force_noise_N * noise.force_noise_N + from_depth_N * from_depth_N) / points[i].samples;
  }
  test.add_covariance([&](std::size_t i, std::size_t j) {
    const double apart_m = std::abs(points[i].depth_m - points[j].depth_m);
    const double u = apart_m / smooth.length_m;
    const double s_N = smooth.relative * scale_N;
    const double share = std::max(0.0, 1.0 - apart_m / noise.fluctuation_length_m);
    const double e2 = noise.fluctuation_relative * noise.fluctuation_relative;
    return s_N * s_N * std::exp(-0.5 * u * u) + e2 * points[i].force_N * points[j].force_N * share +
           (i == j ? variance[i] : 0.0);
  });
  const auto term = [&](double sd, auto&& value) {
    test.add_term(sd, [&](std::size_t i) { return value(points[i]); });
  };
  const double wide_N = kDiffuse * scale_N;
  const double slope_N_per_m = scale_N / deepest_m;
  term(std::hypot(config.offset_sd_N, slope_N_per_m * noise.surface_sd_m), [](const Point&) { return 1.0; });
  term(wide_N, [&](const Point& p) { return p.depth_m / deepest_m; });
  term(wide_N, [&](const Point& p) { return p.depth_m * p.depth_m / (deepest_m * deepest_m); });
  term(wide_N, [&](const Point& p) { return 1.0 - std::exp(-p.depth_m / noise.intercept_growth_depth_m); });
  term(stance.added_mass.sd, [](const Point& p) { return p.inertia_N; });
  term(noise.joint_friction_sd_N, [](const Point& p) { return p.friction; });
  term(slope_N_per_m * noise.depth_drift_sd_mps, [](const Point& p) { return p.time_s; });
  return test;
}

// Finds the best of many templates.
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

  // The best event if it exceeds the threshold, otherwise one of kind `none`.
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

constexpr double kPlaces_m = 1e-3;  // distance between tried places
constexpr double kFirstBoundary_m = 0.003;
constexpr std::array kRises_m{0.001, 0.002, 0.004};
constexpr std::array kDecays_m{0.0005, 0.0015};
constexpr std::array kWidths_m{0.001, 0.002, 0.004};

struct Rupture {
  double place_m, rise_m, decay_m;
  double operator()(double z) const {
    constexpr double kGone = 8.0;  // exp(-8) = 3e-4 counts as zero, which shortens the test
    if (z <= place_m) return std::max(0.0, 1.0 - (place_m - z) / rise_m);
    const double decayed = (z - place_m) / decay_m;
    return decayed < kGone ? std::exp(-decayed) : 0.0;
  }
};

// Mean force minus added-mass force between two depths; NaN if there is no point.
double mean_ground_N(const Stance& stance, double from_m, double to_m) {
  double sum = 0.0, count = 0.0;
  for (const auto& p : stance.points)
    if (p.depth_m > from_m && p.depth_m < to_m) {
      sum += stance.ground_N(p);
      count += 1.0;
    }
  return sum / count;
}

// True if the end of a reloading's damping explains the fall of the force.
bool resumes_at(const Stance& stance, double place_m) {
  constexpr double kResumes_m = 0.001, kAfter_m = 0.004;
  return std::ranges::any_of(stance.resumed, [&](const GroundEventSums::Resumption& resumed) {
    const double at_m = resumed.depth_m;
    if (at_m < 0.0 || std::abs(place_m - at_m) > kResumes_m) return false;
    return !(mean_ground_N(stance, at_m + kResumes_m, at_m + kAfter_m) < resumed.bearing_N);
  });
}

// A rupture is a fall of the force; a steep rise at the end of the stance is none.
bool falls_after(const Stance& stance, const Point& p) {
  constexpr double kAfter_m = 0.004;
  return mean_ground_N(stance, p.depth_m, p.depth_m + kAfter_m) < stance.ground_N(p);
}

void offer_ruptures(Search& search, const Stance& stance) {
  for (const auto& p : stance.points) {
    if (!falls_after(stance, p) || resumes_at(stance, p.depth_m)) continue;
    for (const double rise_m : kRises_m)
      for (const double decay_m : kDecays_m)
        search.offer(p.depth_m, GroundEventKind::crust_rupture, false, Rupture{p.depth_m, rise_m, decay_m});
  }
}

void offer_boundaries(Search& search, double deepest_m) {
  for (double place_m = kFirstBoundary_m; place_m < deepest_m; place_m += kPlaces_m) {
    for (const double width_m : kWidths_m)
      search.offer(place_m, GroundEventKind::layer_boundary, true,
                   [&](double z) { return z / (1.0 + std::exp((place_m - z) / width_m)); });
    search.offer(place_m, GroundEventKind::box_floor, false,
                 [&](double z) { return std::max(0.0, z - place_m); });
  }
}

// Adds the shape of the event found to the null hypothesis; for a rupture, every rise and decay that was
// tried.
void absorb(NormalTest& test, std::span<const Point> points, const GroundEvent& event,
            std::span<const double> shape) {
  const double sd = kDiffuse * greatest_force_N(points);
  if (event.kind != GroundEventKind::crust_rupture) {
    const double greatest =
        std::abs(*std::ranges::max_element(shape, {}, [](double x) { return std::abs(x); }));
    test.add_term(sd / greatest, [&](std::size_t i) { return shape[i]; });
    return;
  }
  // The place of a rupture is known to about one step of the search, so the shapes of both neighbours are
  // added, too.
  for (const double beside_m : {-kPlaces_m, 0.0, kPlaces_m})
    for (const double rise_m : kRises_m)
      for (const double decay_m : kDecays_m)
        test.add_term(sd, [&](std::size_t i) {
          return Rupture{event.depth_m + beside_m, rise_m, decay_m}(points[i].depth_m);
        });
}

GroundEvent find_rupture(const Stance& stance, const GroundEventConfig& config) {
  const auto& points = stance.points;
  auto test = smooth_bed(stance, config, {config.rupture_smooth_length_m, config.rupture_smooth_relative});
  Search search(test, points);
  offer_ruptures(search, stance);
  offer_boundaries(search, points.back().depth_m);
  const auto best = search.event(config.false_alarm_probability, false);
  if (best.kind == GroundEventKind::crust_rupture || best.kind == GroundEventKind::none) return best;
  absorb(test, points, best, search.best_shape());
  Search beside(test, points);
  offer_ruptures(beside, stance);
  return beside.event(config.false_alarm_probability, false);
}

GroundEvent find_boundary(const Stance& stance, const GroundEventConfig& config, const GroundEvent& rupture) {
  const auto& points = stance.points;
  auto test = smooth_bed(stance, config, {config.smooth_length_m, config.smooth_relative});
  if (rupture.kind != GroundEventKind::none) absorb(test, points, rupture, {});
  Search search(test, points);
  offer_boundaries(search, points.back().depth_m);
  return search.event(config.false_alarm_probability, true);
}

constexpr double kFloorBelow_m = 0.004;  // the suction begins within this distance of the depth at which the
                                         // load ended

// Uses the points from the first depth at which the foot no longer bears an upward load.
GroundEvent find_suction(const DepthBins& up, const GroundEventConfig& config) {
  auto points = points_of(up);
  const double free_N = 2.0 * config.noise.force_noise_N;
  const auto loaded =
      std::find_if(points.rbegin(), points.rend(), [&](const Point& p) { return p.force_N < free_N; });
  points.erase(loaded.base(), points.end());
  // The ground cannot push a foot that leaves. A greater force comes from the leg at its end stop.
  const double most_N = 5.0 * std::hypot(config.noise.force_noise_N, config.offset_sd_N);
  const auto pushed =
      std::find_if(points.rbegin(), points.rend(), [&](const Point& p) { return p.force_N > most_N; });
  points.erase(points.begin(), pushed.base());
  if (points.size() < 8) return {};
  const double noise2 = config.noise.force_noise_N * config.noise.force_noise_N;
  NormalTest test(points.size(), 2);
  for (std::size_t i = 0; i < points.size(); ++i) test.observe(i, points[i].force_N);
  test.add_covariance([&](std::size_t i, std::size_t j) {
    const double apart_m = points[i].depth_m - points[j].depth_m;
    const auto smooth = [&](double sd_N, double length_m) {
      const double u = apart_m / length_m;
      return sd_N * sd_N * std::exp(-0.5 * u * u);
    };
    return smooth(config.offset_sd_N, config.smooth_length_m) +
           smooth(config.noise.force_noise_N, config.rupture_smooth_length_m) +
           (i == j ? noise2 / points[i].samples : 0.0);
  });
  test.add_term(config.offset_sd_N, [](std::size_t) { return 1.0; });
  test.add_term(config.noise.joint_friction_sd_N, [&](std::size_t i) { return points[i].friction; });
  Search search(test, points);
  const double top_m = points.back().depth_m;
  for (const double length_m : {0.003, 0.006, 0.012})
    for (double floor_m = top_m + length_m / 3.0; floor_m > top_m - kFloorBelow_m; floor_m -= kPlaces_m)
      search.offer(floor_m - length_m / 3.0, GroundEventKind::suction, false, [&](double z) {
        const double u = (floor_m - z) / length_m;
        return u > 0.0 && u < 1.0 ? -6.75 * u * (1.0 - u) * (1.0 - u) : 0.0;
      });
  return search.event(config.false_alarm_probability, false);
}

}  // namespace

GroundEventConfig ground_event_config(const StiffnessConfig& config) noexcept {
  GroundEventConfig events;
  events.noise = config.joint;
  return events;
}

GroundEvents find_ground_events(const GroundEventSums& sums, const GroundEventConfig& config,
                                const StrengthProfile& profile) {
  GroundEvents events{.stride = sums.stride};
  events.suction = find_suction(sums.up, config);
  const Stance stance{points_of(sums.down), sums.resumed, added_mass_of(sums, config.noise, profile)};
  if (stance.points.size() < kLeastPoints) return events;
  events.rupture = find_rupture(stance, config);
  events.boundary = find_boundary(stance, config, events.rupture);
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
