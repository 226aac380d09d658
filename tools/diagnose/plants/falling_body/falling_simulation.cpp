#include "tools/diagnose/plants/falling_body/falling_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/diagnose/plants/ground_laws.hpp"

namespace sandhopper::diagnose {
namespace {

std::size_t index(int nuisance) { return static_cast<std::size_t>(nuisance); }

// Going down the body is always where the bed is untouched; added mass is not modelled here.
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

FallingMotion Fall::simulate(const Edits& edits, std::span<const double> nuisances, bool stop) const {
  FallingFigures f(belief, edits);
  f.mass_kg += payload_kg;
  if (length_m > 0.0) f.surface_height_m = surface_m;
  if (bed_nuisance >= 0) {
    f.bed_stiffness_N_per_m *= 1.0 + nuisances[index(bed_nuisance)];
    f.surface_height_m += nuisances[index(bed_nuisance) + 1];
  }
  const auto laws = edits.at("body");
  const auto added_mass = edits.at("body.added_mass");
  const GroundLaws ground(edits);
  const double displaced_kg = f.density_kg_per_m3 * f.volume_m3;
  const double weight_N = f.mass_kg * f.gravity_mps2;
  const double buoyancy_N = f.buoyancy_factor * displaced_kg * f.gravity_mps2;
  const double quadratic = 0.5 * f.density_kg_per_m3 * f.area_m2 * f.drag_coefficient;
  double let_go_s = stop ? impact_s : release_s;
  if (release_nuisance >= 0) let_go_s += nuisances[index(release_nuisance)];
  const bool told = touchdown_nuisance >= 0;  // when the bed begins
  const double told_s = told ? touchdown_s + nuisances[index(touchdown_nuisance)] : 1e300;
  bool on_bed = stop;
  const auto accel = [&](double t, double h, double v) {
    const double depth_m = f.surface_height_m - h;
    const auto carried_kg = [&](double d) {
      return wetted_share(d, length_m) * f.added_mass_factor * displaced_kg + sum_of(added_mass, {.load = d});
    };
    double force_N =
        wetted_share(depth_m, length_m) * buoyancy_N - weight_N -
        wetted_share(depth_m, front_m(length_m)) * (quadratic * std::abs(v) + f.linear_drag_N_s_per_m) * v;
    const double inertia_kg = f.mass_kg + carried_kg(depth_m);
    if (length_m > 0.0 && v < 0.0) {
      constexpr double kApart_m = 1e-5;
      const double taken_up_kg = carried_kg(depth_m + kApart_m) - carried_kg(depth_m - kApart_m);
      force_N += taken_up_kg / (2.0 * kApart_m) * v * v;
    }
    if (bed && v < 0.0 && (on_bed || !told)) force_N += bed_force_N(f, ground, depth_m, -v);
    if (!laws.empty())
      force_N += sum_of(
          laws,
          {.time_s = t - let_go_s, .position = h, .velocity = v, .load = depth_m, .extreme = start_height_m});
    return force_N / inertia_kg;
  };
  const auto count = static_cast<std::size_t>(std::ceil(end_s / step_s)) + 2;
  FallingMotion m;
  for (Signal* s : {&m.height, &m.velocity, &m.accel}) *s = {0.0, step_s, std::vector<double>(count, 0.0)};
  constexpr double kFarAbove_m = 1e6;
  struct {
    double t, h, v;
  } s{0.0, start_height_m + nuisances[0] - to_entry_s * nuisances[1] + (impact_s >= 0.0 ? kFarAbove_m : 0.0),
      start_speed_mps + nuisances[1]};
  if (stop) {
    s.h = f.surface_height_m + nuisances[index(impact_nuisance)];
    s.v = impact_speed_mps + nuisances[index(impact_nuisance) + 1];
  }
  bool falling = !held, resting = false, reached = false;
  double speed_at_surface_mps = 0.0;
  const auto advance = [&](double dt) {
    const double a1 = accel(s.t, s.h, s.v);
    const double a2 = accel(s.t + 0.5 * dt, s.h + 0.5 * dt * s.v, s.v + 0.5 * dt * a1);
    const double a3 = accel(s.t + 0.5 * dt, s.h + 0.5 * dt * (s.v + 0.5 * dt * a1), s.v + 0.5 * dt * a2);
    const double a4 = accel(s.t + dt, s.h + dt * (s.v + 0.5 * dt * a2), s.v + dt * a3);
    const double before_m = s.h - f.surface_height_m, before_mps = s.v;
    s.h += dt * (s.v + dt * (a1 + a2 + a3) / 6.0);
    s.v += dt * (a1 + 2.0 * (a2 + a3) + a4) / 6.0;
    s.t += dt;
    if (!reached && before_m > 0.0 && s.h <= f.surface_height_m) {
      // The time at which a parabola through both ends crosses the surface.
      const double a = (s.v - before_mps) / dt;
      const double root = std::sqrt(std::max(0.0, before_mps * before_mps - 2.0 * a * before_m));
      const double part_s = std::clamp(2.0 * before_m / (root - before_mps), 0.0, dt);
      reached = true;
      m.touchdown_s = s.t - dt + part_s;
      speed_at_surface_mps = before_mps + a * part_s;
    }
    resting = bed && (on_bed || !told) && s.v >= 0.0 && s.h < f.surface_height_m;
  };
  const auto advance_to = [&](double t, int parts) {
    const double dt = (t - s.t) / parts;
    for (int part = 0; part < parts && !resting; ++part) advance(dt);
  };
  for (std::size_t i = 0; i < count; ++i) {
    const double grid_s = step_s * static_cast<double>(i);
    if (!falling && grid_s > let_go_s) {
      falling = true;
      s.t = std::max(let_go_s, grid_s - step_s);
    }
    if (falling && told && !on_bed && grid_s > told_s) {
      // The fall goes on to the surface, be it too late or too early; the bed begins there when it is told.
      if (s.t < told_s) advance_to(told_s, 1);
      for (int more = 0; !reached && more < 4000; ++more) advance(step_s);
      if (!reached) m.touchdown_s = s.t;
      on_bed = true;
      s = {std::max(told_s, grid_s - step_s), f.surface_height_m, reached ? speed_at_surface_mps : s.v};
    }
    if (falling && !resting && grid_s > s.t) {
      // The bed begins with a kink: short steps near and in it.
      const bool near_bed =
          bed && (on_bed || (!told && s.h + 2.0 * (grid_s - s.t) * std::min(s.v, 0.0) < f.surface_height_m));
      advance_to(grid_s, near_bed ? 5 : 1);
      s.t = grid_s;
    }
    m.height.values[i] = s.h;
    m.velocity.values[i] = falling && !resting ? s.v : 0.0;
    m.accel.values[i] = falling && !resting ? accel(grid_s, s.h, s.v) : 0.0;
  }
  if (!reached && m.touchdown_s == 0.0) m.touchdown_s = end_s;
  return m;
}

}  // namespace sandhopper::diagnose
