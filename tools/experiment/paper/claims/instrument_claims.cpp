#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "tools/experiment/paper/claims/claims.hpp"

namespace sandhopper::paper {
namespace {

Claim logging_rate(const ProgrammeResults& r) {
  const auto e = errors_of_all(r);
  const auto stale = [&e](double fresh) { return 100.0 * (1.0 - fresh / e.cycles); };
  const double load_cell = stale(e.fresh_load_cell);
  Claim c{1, "All sensors are logged at 1 kHz",
          "rows 1 ms apart, each with a fresh sample of every sensor; 860 samples/s leave 14 % of the rows "
          "without one"};
  c.figures = {{"largest error of a row's time", 1e6 * e.longest_step_error_s, "µs", 2},
               {"rows without a fresh load-cell sample", load_cell, "%", 1},
               {"rows without a fresh time-of-flight sample", stale(e.fresh_tof), "%", 1},
               {"rows without a fresh motion-capture frame", stale(e.fresh_mocap), "%", 1}};
  const bool on_time = e.longest_step_error_s < 1e-6;
  c.verdict = !on_time ? Verdict::does_not : load_cell < 1.0 ? Verdict::comes_out : Verdict::only_if;
  c.why = fmt::format(
      "a row may repeat an older sample: the rows are on time, but a converter of {:.0f} samples/s leaves "
      "{:.0f} % of them without a new force, and a {:.0f} Hz camera more",
      r.setup.world.sensors.load_cell_rate_Hz, load_cell, r.setup.world.sensors.mocap_rate_Hz);
  return c;
}

Claim foot_size(const ProgrammeResults& r) {
  constexpr double kFootHeight_m = 0.050;
  const auto& world = r.setup.world;
  const double area_m2 = std::numbers::pi * std::pow(world.robot.leg.foot_radius_m, 2);
  const double archimedes = world.terrain.bulk_density_kg_per_m3 * world.gravity_mps2 * area_m2;
  const auto trials = complete_trials(r);
  const auto deep = [](const HopResult& h) { return h.shape.max_depth_m > kFootHeight_m; };
  const double too_deep = share_of(trials, deep) * static_cast<double>(trials.size());
  const double flagged =
      share_of(trials,
               [&](const HopResult& h) { return deep(h) && h.validity == Validity::deeper_than_foot; }) *
      static_cast<double>(trials.size());
  Claim c{2, "The foot is a disk of 80 mm with sides of 50 mm",
          "⟦A⟧ = 50.27 cm²; every stride within 50 mm, deeper ones flagged"};
  c.figures = {{"area", 1e4 * area_m2, "cm²", 2},
               {"⟦rho g A⟧", archimedes, "N/m", 1},
               {"⟦k / (rho g A)⟧", world.terrain.stiffness_N_per_m / archimedes, "", 1},
               {"strides deeper than 50 mm", too_deep, "", 0},
               {"of those flagged by the firmware", flagged, "", 0}};
  const bool area_right = std::abs(1e4 * area_m2 - 50.27) < 0.005;
  c.verdict = !area_right ? Verdict::does_not : too_deep > 0.0 ? Verdict::only_if : Verdict::comes_out;
  c.why = fmt::format(
      "fast strides with the softest leg are left out: {:.0f} of {} strides sink over the foot's top, where "
      "sand flows over it; the firmware calls {:.0f} of them not valid",
      too_deep, trials.size(), flagged);
  return c;
}

}  // namespace

std::vector<Claim> instrument_claims(const ProgrammeResults& results) {
  return {logging_rate(results), foot_size(results)};
}

}  // namespace sandhopper::paper
