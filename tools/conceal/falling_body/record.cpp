#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/conceal/core/dormand_prince.hpp"
#include "tools/conceal/falling_body/world.hpp"

namespace sandhopper::conceal::falling_body {
namespace {

using State = std::array<double, 2>;  // height, speed (up)
constexpr double kStep_s = 1e-3;
constexpr double kStay_s = 0.05;  // Recorded time after the body has come to rest in the bed.

struct Fall {
  const World& world;
  double release_m;
  double bed_N_per_m;

  double hidden_N(double t_s, double h_m, double v_mps) const {
    const auto& x = world.hidden;
    const double speed = std::abs(v_mps), off = (h_m - x.gust_at_m) / x.gust_width_m;
    double force = -(x.quadratic * speed + x.linear_N_s_per_m) * v_mps;
    force += x.gust_N * std::exp(-off * off);
    force += x.tether_N_per_m * std::max(0.0, release_m - h_m - x.tether_slack_m);
    force += x.flutter_N * std::sin(2.0 * std::numbers::pi * x.flutter_Hz_per_mps * (release_m - h_m)) *
             speed * speed;
    if (t_s > x.opening_at_s)
      force += x.opening_N_s2 * speed * speed * (1.0 - std::exp((x.opening_at_s - t_s) / 0.1));
    return force;
  }

  double acceleration_mps2(double t_s, const State& s) const {
    const auto& w = world;
    const double displaced_kg = w.density_kg_per_m3 * w.volume_m3;
    const double mass_kg = w.mass_kg * (1.0 + w.hidden.mass_share);
    const double inertia_kg = mass_kg + (w.added_mass_factor + w.hidden.added_mass) * displaced_kg;
    double force = (-mass_kg + (w.buoyancy_factor + w.hidden.buoyancy) * displaced_kg) * w.gravity_mps2;
    force -= 0.5 * w.density_kg_per_m3 * w.frontal_area_m2 * w.drag_coefficient * std::abs(s[1]) * s[1];
    force -= w.linear_drag_N_s_per_m * s[1];
    force += hidden_N(t_s, s[0], s[1]);
    if (w.has_bed && s[1] < 0.0) force += bed_N_per_m * std::max(0.0, w.surface_height_m - s[0]);
    return force / inertia_kg;
  }
};

}  // namespace

Table record(const World& w, const Setup& setup, const TrialRandom& trial) {
  const double height_m = setup.number("release_height_m", 2.0) +
                          trial.stream("release height").normal(0.0, w.release_height_spread_m);
  const double speed_mps = -setup.number("release_speed_mps", 0.0) +
                           trial.stream("release speed").normal(0.0, w.release_speed_spread_mps);
  World mine = w;
  // A weighed payload is part of the body, but the hidden error of the mass must not apply to it.
  mine.mass_kg += setup.number("payload_kg", 0.0) / (1.0 + w.hidden.mass_share);
  const Fall fall{mine, height_m,
                  w.bed_stiffness_N_per_m * (1.0 + trial.stream("bed").normal(0.0, w.bed_stiffness_spread))};

  Trace height{kStep_s, {}}, specific{kStep_s, {}};
  State s{height_m, speed_mps};
  DormandPrince<2> integrator;
  const auto rhs = [&](double t, const State& y) { return State{y[1], fall.acceleration_mps2(t, y)}; };
  // Without a bed the recording ends at the ground; with a bed when the body has come to rest.
  const auto guard = [&](double, const State& y) {
    return w.has_bed && y[0] < w.surface_height_m ? -y[1]
                                                  : y[0] - w.surface_height_m + (w.has_bed ? 1e3 : 0.0);
  };
  double t_s = 0.0;
  while (t_s < 15.0) {
    height.values.push_back(s[0]);
    specific.values.push_back(fall.acceleration_mps2(t_s, s) + w.gravity_mps2);
    if (integrator.advance(t_s, s, static_cast<double>(height.values.size()) * kStep_s, rhs, guard)) break;
  }
  if (w.has_bed)
    for (int i = 0; i < static_cast<int>(kStay_s / kStep_s); ++i)
      height.values.push_back(s[0]), specific.values.push_back(w.gravity_mps2);

  const double duration_s = static_cast<double>(height.values.size() - 1) * kStep_s;
  const auto rows = static_cast<std::size_t>(duration_s * w.row_rate_Hz) + 1;
  std::vector<double> rows_s(rows);
  for (std::size_t i = 0; i < rows; ++i) rows_s[i] = static_cast<double>(i) / w.row_rate_Hz;
  Table table;
  table.add("t_s", 6).values = rows_s;
  if (w.has_height)
    record_channel(table, "height_m", height, rows_s,
                   {.rate_Hz = w.height_rate_Hz, .noise = w.height_noise_m, .quantum = 1e-4, .decimals = 4},
                   w.faults_of("height_m"), trial);
  if (w.has_accel)
    record_channel(table, "accel_mps2", specific, rows_s,
                   {.offset = trial.stream("bias").normal(0.0, w.accel_bias_spread_mps2),
                    .noise = w.accel_noise_mps2,
                    .quantum = 1e-3,
                    .decimals = 3},
                   w.faults_of("accel_mps2"), trial);
  return table;
}

}  // namespace sandhopper::conceal::falling_body
