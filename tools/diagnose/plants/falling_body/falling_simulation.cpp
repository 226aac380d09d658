#include "tools/diagnose/plants/falling_body/falling_simulation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tools/diagnose/plants/ground_laws.hpp"

namespace sandhopper::diagnose {
namespace {

std::size_t index(int nuisance) { return static_cast<std::size_t>(nuisance); }

// Force of the bed on a body that goes down: it is always at a new depth. The bed's added mass is not
// modelled.
double bed_force_N(const FallingFigures& f, const GroundLaws& ground, double depth_m, double speed_mps) {
  if (depth_m <= 0.0) return 0.0;
  const double quasi_static_N = f.bed_stiffness_N_per_m * depth_m;
  if (ground.empty()) return quasi_static_N;
  const double static_N = ground.quasi_static_N(quasi_static_N, depth_m);
  const BedContact contact{
      .depth_m = depth_m, .speed_mps = speed_mps, .max_depth_m = depth_m, .damping_mass_kg = 0.0};
  return std::max(0.0, static_N + ground.added(contact, static_N, static_N, true).force_N);
}

}  // namespace

FallingFigures::FallingFigures(const Belief& belief, const Edits& edits) {
  const auto read = [&](const char* key, double otherwise) {
    return edits.edited(key, belief.value(key, otherwise));
  };
  gravity_mps2 = read("gravity_mps2", 9.81);
  mass_kg = std::max(1e-9, read("body.mass_kg", 1.0));
  area_m2 = read("body.frontal_area_m2", 0.0);
  volume_m3 = read("body.volume_m3", 0.0);
  density_kg_per_m3 = read("medium.density_kg_per_m3", 0.0);
  drag_coefficient = read("medium.drag_coefficient", 0.0);
  linear_drag_N_s_per_m = read("medium.linear_drag_N_s_per_m", 0.0);
  buoyancy_factor = read("medium.buoyancy_factor", 0.0);
  added_mass_factor = read("medium.added_mass_factor", 0.0);
  medium_mps = read("medium.upward_mps", 0.0);
  surface_height_m = read("bed.surface_height_m", 0.0);
  bed_stiffness_N_per_m = read("bed.stiffness_N_per_m", 0.0);
}

double body_length_m(const Belief& belief) {
  constexpr double kUnknown_m = 0.05;
  if (const double area = belief.value("body.frontal_area_m2"); area > 0.0)
    return 2.0 * std::sqrt(area / std::numbers::pi);
  const double volume = belief.value("body.volume_m3");
  return volume > 0.0 ? std::cbrt(volume) : kUnknown_m;
}

double wetted_share(double depth_m, double length_m) {
  return length_m > 0.0 ? std::clamp(depth_m / length_m, 0.0, 1.0) : 1.0;
}

namespace {

struct FallState {
  double t, h, v;
};

// One fall while it is simulated.
class Falling {
 public:
  Falling(const Fall& fall, const Edits& edits, std::span<const double> nuisances, bool stop)
      : fall_(fall),
        f_(fall.belief, edits),
        laws_(edits.at(LawPort::body)),
        added_mass_(edits.at(LawPort::body_added_mass)),
        ground_(edits),
        on_bed_(stop) {
    f_.mass_kg += fall.payload_kg;
    if (fall.length_m > 0.0) f_.surface_height_m = fall.surface_m;
    if (fall.bed_nuisance >= 0) {
      f_.bed_stiffness_N_per_m *= 1.0 + nuisances[index(fall.bed_nuisance)];
      f_.surface_height_m += nuisances[index(fall.bed_nuisance) + 1];
    }
    displaced_kg_ = f_.density_kg_per_m3 * f_.volume_m3;
    weight_N_ = f_.mass_kg * f_.gravity_mps2;
    buoyancy_N_ = f_.buoyancy_factor * displaced_kg_ * f_.gravity_mps2;
    quadratic_ = 0.5 * f_.density_kg_per_m3 * f_.area_m2 * f_.drag_coefficient;
    let_go_s_ = stop ? fall.impact_s : fall.release_s;
    if (fall.release_nuisance >= 0) let_go_s_ += nuisances[index(fall.release_nuisance)];
    touchdown_is_fitted_ = fall.touchdown_nuisance >= 0;
    if (touchdown_is_fitted_)
      fitted_touchdown_s_ = fall.touchdown_s + nuisances[index(fall.touchdown_nuisance)];
    constexpr double kFarAbove_m = 1e6;
    s_ = {0.0,
          fall.start_height_m + nuisances[0] - fall.to_entry_s * nuisances[1] +
              (fall.impact_s >= 0.0 ? kFarAbove_m : 0.0),
          fall.start_speed_mps + nuisances[1]};
    if (stop) {
      s_.h = f_.surface_height_m + nuisances[index(fall.impact_nuisance)];
      s_.v = fall.impact_speed_mps + nuisances[index(fall.impact_nuisance) + 1];
    }
    falling_ = !fall.held;
  }

  FallingMotion run() {
    const double step_s = fall_.step_s;
    const auto count = static_cast<std::size_t>(std::ceil(fall_.end_s / step_s)) + 2;
    FallingMotion m;
    for (Signal* signal : {&m.height, &m.velocity, &m.accel})
      *signal = {0.0, step_s, std::vector<double>(count, 0.0)};
    for (std::size_t i = 0; i < count; ++i) {
      const double grid_s = step_s * static_cast<double>(i);
      advance_to_row(grid_s);
      const bool moves = falling_ && !resting_;
      m.height.values[i] = s_.h;
      m.velocity.values[i] = moves ? s_.v : 0.0;
      m.accel.values[i] = moves ? accel(grid_s, s_.h, s_.v) : 0.0;
    }
    m.touchdown_s = !reached_ && touchdown_s_ == 0.0 ? fall_.end_s : touchdown_s_;
    return m;
  }

 private:
  double accel(double t, double h, double v) const {
    const double length_m = fall_.length_m, depth_m = f_.surface_height_m - h;
    const auto carried_kg = [&](double d) {
      return wetted_share(d, length_m) * f_.added_mass_factor * displaced_kg_ +
             sum_of(added_mass_, BodyState{.depth_m = d});
    };
    const double through_mps = v - f_.medium_mps;
    double force_N = wetted_share(depth_m, length_m) * buoyancy_N_ - weight_N_ -
                     wetted_share(depth_m, front_m(length_m)) *
                         (quadratic_ * std::abs(through_mps) + f_.linear_drag_N_s_per_m) * through_mps;
    const double inertia_kg = f_.mass_kg + carried_kg(depth_m);
    if (length_m > 0.0 && v < 0.0) {
      constexpr double kApart_m = 1e-5;
      const double taken_up_kg = carried_kg(depth_m + kApart_m) - carried_kg(depth_m - kApart_m);
      force_N += taken_up_kg / (2.0 * kApart_m) * v * v;
    }
    if (fall_.bed && v < 0.0 && (on_bed_ || !touchdown_is_fitted_))
      force_N += bed_force_N(f_, ground_, depth_m, -v);
    if (!laws_.empty())
      force_N += sum_of(laws_, BodyState{.time_s = t - let_go_s_,
                                         .height_m = h,
                                         .velocity_mps = v,
                                         .depth_m = depth_m,
                                         .start_height_m = fall_.start_height_m});
    return force_N / inertia_kg;
  }

  // Number of parts of a step in each of which a drag decays by less than 1/e. The method is unstable
  // from 2.8 times that. A part may be divided once more, because the speed changes along a step; a motion
  // that runs away would otherwise never end.
  int parts_of(double dt, int level) const {
    constexpr std::array kMost{1000, 4};  // at each level
    if (level >= static_cast<int>(kMost.size())) return 1;
    const auto [t, h, v] = s_;
    const double apart_mps = 1e-3 * std::abs(v) + 1e-6;
    const double rate = (accel(t, h, v - apart_mps) - accel(t, h, v + apart_mps)) / (2.0 * apart_mps);
    return rate * dt > 1.0 ? static_cast<int>(std::min(std::ceil(rate * dt),
                                                       1.0 * kMost.at(static_cast<std::size_t>(level))))
                           : 1;
  }

  // A Runge-Kutta step of fourth order.
  void advance(double dt, int level = 0) {
    const auto [t, h, v] = s_;
    const double a1 = accel(t, h, v);
    const double a2 = accel(t + 0.5 * dt, h + 0.5 * dt * v, v + 0.5 * dt * a1);
    const double a3 = accel(t + 0.5 * dt, h + 0.5 * dt * (v + 0.5 * dt * a1), v + 0.5 * dt * a2);
    // With a drag of rate l (1/s), (a3 - a2) / (a2 - a1) is -l dt / 2.
    if (2.0 * std::abs(a3 - a2) > std::abs(a2 - a1))
      if (const int parts = parts_of(dt, level); parts > 1) return advance_to(t + dt, parts, level + 1);
    const double a4 = accel(t + dt, h + dt * (v + 0.5 * dt * a2), v + dt * a3);
    const double before_m = h - f_.surface_height_m, before_mps = v;
    s_.h += dt * (v + dt * (a1 + a2 + a3) / 6.0);
    s_.v += dt * (a1 + 2.0 * (a2 + a3) + a4) / 6.0;
    s_.t += dt;
    if (!reached_ && before_m > 0.0 && s_.h <= f_.surface_height_m) {
      // The time at which a parabola through both ends crosses the surface.
      const double a = (s_.v - before_mps) / dt;
      const double root = std::sqrt(std::max(0.0, before_mps * before_mps - 2.0 * a * before_m));
      const double part_s = std::clamp(2.0 * before_m / (root - before_mps), 0.0, dt);
      reached_ = true;
      touchdown_s_ = s_.t - dt + part_s;
      speed_at_surface_mps_ = before_mps + a * part_s;
    }
    resting_ = fall_.bed && (on_bed_ || !touchdown_is_fitted_) && s_.v >= 0.0 && s_.h < f_.surface_height_m;
  }

  void advance_to(double t, int parts, int level = 0) {
    const double dt = (t - s_.t) / parts;
    for (int part = 0; part < parts && !resting_; ++part) advance(dt, level);
  }

  void advance_to_row(double grid_s) {
    const double step_s = fall_.step_s;
    if (!falling_ && grid_s > let_go_s_) {
      falling_ = true;
      s_.t = std::max(let_go_s_, grid_s - step_s);
    }
    if (falling_ && touchdown_is_fitted_ && !on_bed_ && grid_s > fitted_touchdown_s_) {
      // The fall is simulated to the surface, even if it arrives too late or too early. The bed phase begins
      // at the fitted touchdown.
      if (s_.t < fitted_touchdown_s_) advance_to(fitted_touchdown_s_, 1);
      for (int more = 0; !reached_ && more < 4000; ++more) advance(step_s);
      if (!reached_) touchdown_s_ = s_.t;
      on_bed_ = true;
      s_ = {std::max(fitted_touchdown_s_, grid_s - step_s), f_.surface_height_m,
            reached_ ? speed_at_surface_mps_ : s_.v};
    }
    if (falling_ && !resting_ && grid_s > s_.t) {
      // The bed's force has a kink at the surface, so steps near and in the bed are short.
      const bool near_bed =
          fall_.bed &&
          (on_bed_ || (!touchdown_is_fitted_ &&
                       s_.h + 2.0 * (grid_s - s_.t) * std::min(s_.v, 0.0) < f_.surface_height_m));
      advance_to(grid_s, near_bed ? 5 : 1);
      s_.t = grid_s;
    }
  }

  const Fall& fall_;
  FallingFigures f_;
  std::vector<const Law*> laws_, added_mass_;
  GroundLaws ground_;
  double displaced_kg_ = 0.0, weight_N_ = 0.0, buoyancy_N_ = 0.0, quadratic_ = 0.0;
  double let_go_s_ = 0.0;
  bool touchdown_is_fitted_ = false;  // the touchdown is fitted
  double fitted_touchdown_s_ = 1e300;
  FallState s_{};
  bool on_bed_, falling_ = false, resting_ = false, reached_ = false;
  double touchdown_s_ = 0.0, speed_at_surface_mps_ = 0.0;
};

}  // namespace

FallingMotion Fall::simulate(const Edits& edits, std::span<const double> nuisances, bool stop) const {
  return Falling(*this, edits, nuisances, stop).run();
}

}  // namespace sandhopper::diagnose
