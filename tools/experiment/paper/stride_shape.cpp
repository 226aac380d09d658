#include "tools/experiment/paper/stride_shape.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sandhopper::paper {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
constexpr double kEarly_s = 0.060;
constexpr double kRestShare = 0.05;
constexpr double kStill_mps = 0.02;
constexpr std::size_t kTransient_rows = 20;

// Rows and stance of a trial, used by the features below.
struct Stance {
  const std::vector<HopRow>& rows;
  StanceRows at;
  double contact_s;

  double since_contact_s(std::size_t row) const { return rows[row].time_s - contact_s; }
  double down_mps(std::size_t row) const { return -rows[row].truth.foot_velocity_mps; }
};

Stance stance_of(const HopTrial& trial) {
  const auto at = stance_rows(trial);
  const auto& after = trial.rows[at.contact];
  const double late_s = -after.truth.foot_z_m / -after.truth.foot_velocity_mps;
  return {trial.rows, at, after.time_s - std::max(0.0, late_s)};
}

void find_early_peak(const Stance& s, StrideShape& shape) {
  shape.early_peak_N = shape.early_peak_s = shape.early_drop = kNoValue;
  std::size_t peak = 0;
  for (std::size_t i = s.at.contact + 1; s.since_contact_s(i) < kEarly_s; ++i) {
    const double force_N = s.rows[i].mean_force_N;
    const bool local = force_N >= s.rows[i - 1].mean_force_N && force_N > s.rows[i + 1].mean_force_N;
    if (local && (peak == 0 || force_N > s.rows[peak].mean_force_N)) peak = i;
  }
  if (peak == 0) return;
  const auto lowest =
      std::min_element(s.rows.begin() + static_cast<std::ptrdiff_t>(peak),
                       s.rows.begin() + static_cast<std::ptrdiff_t>(std::max(s.at.change, peak + 1)),
                       [](const HopRow& a, const HopRow& b) { return a.mean_force_N < b.mean_force_N; });
  shape.early_peak_N = s.rows[peak].mean_force_N;
  shape.early_peak_s = s.since_contact_s(peak) - 0.0005;  // the middle of its millisecond
  shape.early_drop = 1.0 - lowest->mean_force_N / shape.early_peak_N;
}

// Longest time with a speed below 0.02 m/s that ends in another descent of the foot.
double plateau_s(const Stance& s) {
  double longest_s = kNoValue;
  std::size_t from = 0;
  for (std::size_t i = s.at.contact; i < s.at.liftoff; ++i) {
    const bool still = std::abs(s.down_mps(i)) < kStill_mps;
    if (still && from == 0) from = i;
    if (still || from == 0) continue;
    const double length_s = s.rows[i].time_s - s.rows[from].time_s;
    const bool descends = s.down_mps(i) > 0.0;
    if (descends && !(length_s <= longest_s)) longest_s = length_s;
    from = 0;
  }
  return longest_s;
}

// Time after the switch during which the foot moves down and the body up. Both may begin some cycles after
// the switch.
double opposed_s(const Stance& s) {
  const auto opposed = [&s](std::size_t i) {
    return i < s.at.liftoff && s.down_mps(i) > 0.0 && s.rows[i].truth.body_velocity_mps > 0.0;
  };
  std::size_t from = s.at.change;
  while (from < s.at.liftoff && !opposed(from)) ++from;
  std::size_t to = from;
  while (opposed(to)) ++to;
  return s.rows[to].time_s - s.rows[from].time_s;
}

// Largest upward (or downward) change within 20 ms relative to the acceleration just before the event.
double transient_mps2(const Stance& s, std::size_t event, double direction) {
  const double before = s.rows[event - 2].mean_accel_mps2;
  double largest = 0.0;
  for (std::size_t i = event; i < std::min(event + kTransient_rows, s.rows.size()); ++i)
    largest = std::max(largest, direction * (s.rows[i].mean_accel_mps2 - before));
  return direction * largest;
}

void find_extremes(const Stance& s, StrideShape& shape) {
  std::size_t strongest = s.at.contact, deepest = s.at.contact, shortest = s.at.contact;
  shape.rest_s = kNoValue;
  for (std::size_t i = s.at.contact; i < s.at.liftoff; ++i) {
    if (s.rows[i].mean_force_N > s.rows[strongest].mean_force_N) strongest = i;
    if (s.rows[i].truth.foot_z_m < s.rows[deepest].truth.foot_z_m) deepest = i;
    if (s.rows[i].truth.leg_length_m < s.rows[shortest].truth.leg_length_m) shortest = i;
    if (std::isnan(shape.rest_s) && s.down_mps(i) < kRestShare * shape.touchdown_speed_mps)
      shape.rest_s = s.since_contact_s(i);
  }
  shape.peak_force_N = s.rows[strongest].mean_force_N;
  shape.peak_force_s = s.since_contact_s(strongest);
  shape.max_depth_m = -s.rows[deepest].truth.foot_z_m;
  shape.max_depth_s = s.since_contact_s(deepest);
  shape.shortest_leg_s = s.rows[shortest].time_s - s.rows[s.at.change].time_s;
}

}  // namespace

StrideShape stride_shape(const HopTrial& trial) {
  const Stance s = stance_of(trial);
  const auto& at_change = s.rows[s.at.change].truth;
  StrideShape shape{};
  shape.touchdown_speed_mps = std::max(s.down_mps(s.at.contact - 1), s.down_mps(s.at.contact));
  shape.contact_s = s.contact_s;
  shape.compression_s = s.since_contact_s(s.at.change);
  shape.extension_s = s.rows[s.at.liftoff].time_s - s.rows[s.at.change].time_s;
  find_early_peak(s, shape);
  shape.plateau_s = plateau_s(s);
  shape.switch_foot_mps = -at_change.foot_velocity_mps;
  shape.switch_body_mps = at_change.body_velocity_mps;
  shape.opposed_s = opposed_s(s);
  find_extremes(s, shape);
  shape.liftoff_depth_m = -s.rows[s.at.liftoff].truth.foot_z_m;
  shape.touchdown_transient_mps2 = transient_mps2(s, s.at.contact, 1.0);
  shape.switch_transient_mps2 = transient_mps2(s, s.at.change, -1.0);
  shape.liftoff_transient_mps2 = transient_mps2(s, s.at.liftoff, 1.0);
  return shape;
}

}  // namespace sandhopper::paper
