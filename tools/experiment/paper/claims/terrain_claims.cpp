#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>

#include "terrain/bed.hpp"
#include "tools/experiment/paper/claims/claims.hpp"
#include "tools/experiment/statistics.hpp"

namespace sandhopper::paper {
namespace {

constexpr double kFast_mps = 0.7;  // at and above this speed the inertial terms must be visible

Claim slow_force_is_linear(const ProgrammeResults& r) {
  constexpr double kTransient_m = 0.005;
  std::vector<double> r_squared;
  for (const auto& run : r.actuator) {
    if (run.speed_mps > r.inertial_speed_mps) continue;
    std::vector<double> depth_m, force_N;
    for (const auto& sample : run.samples) {
      if (sample.depth_m < kTransient_m) continue;
      depth_m.push_back(sample.depth_m);
      force_N.push_back(sample.force_N);
    }
    r_squared.push_back(fit_line(depth_m, force_N).r_squared);
  }
  Claim c{26, "At low speed the force is linear in depth past a transient",
          "⟦R^2 > 0.99⟧ deeper than 5 mm in every slow run"};
  c.figures = {{"slow runs", static_cast<double>(r_squared.size()), "", 0},
               {"⟦R^2⟧, smallest", smallest(r_squared), "", 4},
               {"⟦R^2⟧, mean", mean(r_squared), "", 4}};
  c.verdict = comes_out_if(smallest(r_squared) > 0.99);
  c.why = "the first millimetres are steeper: the cone under the foot has still to form";
  return c;
}

// Force at a depth, interpolated between two samples of a run; NaN outside.
double force_at(const ActuatorRun& run, double depth_m) {
  for (std::size_t i = 1; i < run.samples.size(); ++i) {
    const auto& a = run.samples[i - 1];
    const auto& b = run.samples[i];
    if (a.depth_m <= depth_m && b.depth_m > depth_m)
      return a.force_N + (b.force_N - a.force_N) * (depth_m - a.depth_m) / (b.depth_m - a.depth_m);
  }
  return std::nan("");
}

Claim speed_squared(const ProgrammeResults& r) {
  constexpr double kDepth_m = 0.002;
  constexpr double kFrom_mps = 0.3;
  std::vector<double> slow_N;
  std::map<double, std::vector<double>> fast_N;
  for (const auto& run : r.actuator) {
    const double force_N = force_at(run, kDepth_m);
    if (!std::isfinite(force_N)) continue;
    if (run.speed_mps <= r.inertial_speed_mps) slow_N.push_back(force_N);
    if (run.speed_mps > kFrom_mps) fast_N[run.speed_mps].push_back(force_N);
  }
  std::vector<double> log_speed, log_force;
  for (const auto& [speed_mps, force_N] : fast_N) {
    const double above_N = mean(force_N) - mean(slow_N);
    if (above_N <= 0.0) continue;
    log_speed.push_back(std::log(speed_mps));
    log_force.push_back(std::log(above_N));
  }
  const double exponent = fit_line(log_speed, log_force).slope;
  Claim c{27, "Above ⟦sqrt(2 d g)⟧ = 0.08 m/s the force grows with the square of the speed",
          "0.0767 m/s; exponent of ⟦F - F_d⟧ at 2 mm of 2 ± 0.2 above 0.3 m/s"};
  c.figures = {{"⟦sqrt(2 d g)⟧", r.inertial_speed_mps, "m/s", 4},
               {"exponent", exponent, "", 3},
               {"quasi-static force at 2 mm", mean(slow_N), "N", 2}};
  c.verdict =
      comes_out_if(std::abs(r.inertial_speed_mps - 0.0767) < 0.00005 && std::abs(exponent - 2.0) <= 0.2);
  c.why = "strokes at constant speed: there only a grain that begins to move with the foot is accelerated";
  return c;
}

Claim map_is_not_enough(const ProgrammeResults& r) {
  Claim c{28, "Depth and speed alone do not explain the force of a hop",
          "rms of what remains falls by at least 30 % when ⟦m_a z''⟧ is added, from 0.7 m/s on"};
  bool passed = true;
  for (const auto& d : decomposition_by_speed(r, &HopResult::truth)) {
    c.figures.push_back({fmt::format("map alone, {:.2f} m/s", d.speed_mps), d.map_N, "N", 2});
    c.figures.push_back({fmt::format("falls by, {:.2f} m/s", d.speed_mps), d.drop_percent(), "%", 1});
    passed = passed && (d.speed_mps < kFast_mps || d.drop_percent() >= 30.0);
  }
  double instruments = 100.0, robot = 100.0;
  for (const auto& d : decomposition_by_speed(r, &HopResult::instruments))
    if (d.speed_mps >= kFast_mps) instruments = std::min(instruments, d.drop_percent());
  for (const auto& d : decomposition_by_speed(r, &HopResult::robot))
    if (d.speed_mps >= kFast_mps) robot = std::min(robot, d.drop_percent());
  c.figures.push_back(
      {"with the load cell's force: falls by at least, from 0.7 m/s on", instruments, "%", 1});
  c.figures.push_back(
      {"with the robot's own force and depth: falls by at least, from 0.7 m/s on", robot, "%", 1});
  c.verdict = comes_out_if(passed);
  c.why = fmt::format(
      "while the foot goes to new depths, with true force and motion; by the robot's own force and depth it "
      "falls by {:.0f} % only, because the height sensor's offset moves the map. On the plateau and in "
      "unloading the map fails for another reason, plasticity",
      robot);
  return c;
}

Claim added_mass_explains(const ProgrammeResults& r) {
  Claim c{29, "⟦m_a z''⟧ matches the remainder in timing and shape",
          "correlation at least 0.7 on penetrating samples, from 0.7 m/s on"};
  bool passed = true;
  for (const auto& d : decomposition_by_speed(r, &HopResult::truth)) {
    c.figures.push_back({fmt::format("correlation, {:.2f} m/s", d.speed_mps), d.correlation, "", 2});
    passed = passed && (d.speed_mps < kFast_mps || d.correlation >= 0.7);
  }
  for (const auto& d : decomposition_by_speed(r, &HopResult::robot))
    if (d.speed_mps >= kFast_mps)
      c.figures.push_back(
          {fmt::format("by the robot's own estimates, {:.2f} m/s", d.speed_mps), d.correlation, "", 2});
  c.verdict = comes_out_if(passed);
  c.why = "⟦m_a⟧ is integrated from the actuator set's map; nothing is fitted to the hop";
  return c;
}

// Largest relative difference between the integrated gradient and the bed's added mass, from 1 to 30 mm.
double worst_profile(const ForceMap& map, const Bed& bed) {
  double worst = 0.0;
  for (int mm = 1; mm <= 30; ++mm) {
    const double error = map.added_mass_kg(1e-3 * mm) / bed.added_mass_kg(1e-3 * mm) - 1.0;
    if (std::abs(error) > std::abs(worst)) worst = error;
  }
  return worst;
}

Claim added_mass_saturates(const ProgrammeResults& r) {
  const Bed bed(r.setup.world.terrain, r.setup.world.robot.leg.foot_radius_m);
  const double aligned = worst_profile(r.map, bed);
  const double lagging = worst_profile(r.map_with_lag, bed);
  const double late_gradient = r.map.mass_gradient_kg_per_m(0.035) / r.map.mass_gradient_kg_per_m(0.0);
  Claim c{30, "The added mass grows with depth and then saturates",
          "integrated gradient within 20 % of the bed's to 30 mm; gradient at 35 mm below a fifth of that "
          "at the surface"};
  for (const int mm : {5, 10, 20, 30})
    c.figures.push_back({fmt::format("⟦m_a⟧ at {} mm against the bed's", mm),
                         r.map.added_mass_kg(1e-3 * mm) / bed.added_mass_kg(1e-3 * mm), "", 3});
  c.figures.push_back({"largest departure, 1 to 30 mm", 100.0 * aligned, "%", 1});
  c.figures.push_back({"the same with the amplifier's lag left in", 100.0 * lagging, "%", 1});
  c.figures.push_back({"gradient at 35 mm over that at the surface", late_gradient, "", 3});
  const bool shape = late_gradient < 0.2;
  if (!shape || std::abs(aligned) > 0.20)
    c.verdict = Verdict::does_not;
  else
    c.verdict = std::abs(lagging) > 0.20 ? Verdict::only_if : Verdict::comes_out;
  c.why = fmt::format(
      "each force is paired with the depth one amplifier time constant earlier ({:.2f} ms); uncorrected, "
      "the profile is off by {:.0f} %",
      1e3 / (2.0 * std::numbers::pi * r.setup.world.sensors.load_cell_bandwidth_Hz), 100.0 * lagging);
  return c;
}

}  // namespace

std::vector<Claim> terrain_claims(const ProgrammeResults& results) {
  return {slow_force_is_linear(results), speed_squared(results), map_is_not_enough(results),
          added_mass_explains(results), added_mass_saturates(results)};
}

}  // namespace sandhopper::paper
