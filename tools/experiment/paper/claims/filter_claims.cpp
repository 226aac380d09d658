#include <fmt/format.h>

#include <cmath>

#include "tools/experiment/paper/claims/claims.hpp"
#include "tools/experiment/paper/estimator_checks.hpp"

namespace sandhopper::paper {
namespace {

double mean_square(const SquareSum& sum) { return sum.squares / sum.count; }

Claim filter_model(const ProgrammeResults& r) {
  const auto check = filter_check(r.setup.cycle.estimator.kalman);
  const auto e = errors_of_all(r);
  Claim c{9, "Body and foot as a Kalman filter with matrices ⟦A⟧, ⟦B⟧ and ⟦H⟧",
          "observable (rank 4) with ToF, two modes not without; normalised innovations of a true model in "
          "their 95 % band in at least 85 % of runs"};
  c.figures = {{"rank with ToF", static_cast<double>(check.rank_with_tof), "", 0},
               {"rank without", static_cast<double>(check.rank_without_tof), "", 0},
               {"mean normalised squared innovation, true model", check.mean_normalised, "", 4},
               {"runs inside the band", 100.0 * check.runs_inside_band / check.runs, "%", 0},
               {"in hops: ToF", mean_square(e.normalised_innovation[0]), "", 2},
               {"in hops: leg length", mean_square(e.normalised_innovation[1]), "", 2},
               {"in hops: leg rate", mean_square(e.normalised_innovation[2]), "", 2}};
  c.verdict = comes_out_if(check.rank_with_tof == 4 && check.rank_without_tof == 2 &&
                           check.runs_inside_band >= 0.85 * check.runs);
  c.why = "in hops the innovations are smaller than the configured noises expect: the filter is cautious";
  return c;
}

Claim tracks_motion_capture(const ProgrammeResults& r) {
  const auto e = errors_of_all(r);
  const double offset_mm = 1e3 * e.foot_depth_m.rms();
  const double within_mm = 1e3 * e.depth_about_trial_mean_m.rms();
  Claim c{10, "The filter tracks the positions of motion capture",
          "rms of depth at most 4 mm, and at most 1.7 mm about the trial's own mean"};
  c.figures = {{"foot depth, rms", offset_mm, "mm", 2},
               {"foot depth about the trial's mean, rms", within_mm, "mm", 2},
               {"body height, rms", 1e3 * e.body_height_m.rms(), "mm", 2}};
  c.verdict = comes_out_if(offset_mm <= 4.0 && within_mm <= 1.7);
  c.why =
      "nearly all of it is the time-of-flight sensor's offset, constant in a trial; the filter cannot see it";
  return c;
}

Claim velocity_accuracy(const ProgrammeResults& r) {
  const auto e = errors_of_all(r);
  Claim c{11, "The filter gives velocities of high accuracy", "rms at most 0.02 m/s, body and foot"};
  c.figures = {{"foot, rms", e.foot_velocity_mps.rms(), "m/s", 4},
               {"body, rms", e.body_velocity_mps.rms(), "m/s", 4}};
  c.verdict = comes_out_if(e.foot_velocity_mps.rms() <= 0.02 && e.body_velocity_mps.rms() <= 0.02);
  c.why = "over all stances, against the true velocity at the same instant";
  return c;
}

Claim raw_tof(const ProgrammeResults& r) {
  const auto e = errors_of_all(r);
  const double height_mm = 1e3 * e.tof_m.rms();
  Claim c{12, "Time of flight alone is not suitable", "rms at least 5 mm raw, at least 1 m/s differentiated"};
  c.figures = {{"raw height, rms", height_mm, "mm", 2},
               {"its difference over a sample, rms", e.tof_velocity_mps.rms(), "m/s", 2}};
  c.verdict = comes_out_if(height_mm >= 5.0 && e.tof_velocity_mps.rms() >= 1.0);
  c.why = "against the true height at the instant of each reading";
  return c;
}

}  // namespace

std::vector<Claim> filter_claims(const ProgrammeResults& results) {
  return {filter_model(results), tracks_motion_capture(results), velocity_accuracy(results),
          raw_tof(results)};
}

}  // namespace sandhopper::paper
