#include "tools/experiment/paper/estimation_error.hpp"

#include <algorithm>
#include <cmath>

namespace sandhopper::paper {
namespace {

constexpr double kChiSquared95 = 3.841;  // one degree of freedom
constexpr std::int64_t kCycle_ns = 1'000'000;

double seconds(std::int64_t time_ns) { return 1e-9 * static_cast<double>(time_ns); }

// The forces in `row` belong to the instant of the previous row.
void add_forces(const HopRow& before, const HopRow& row, EstimationErrors& errors) {
  const auto& e = row.estimate;
  errors.quasi_static_N.add(e.quasi_static_force_N - before.truth.contact_force_N);
  errors.observer_N.add(e.contact_force_N - before.truth.contact_force_N);
  errors.load_cell_N.add(e.load_cell_force_N - row.truth.contact_force_N);
  errors.quasi_static_to_cell_N.add(e.quasi_static_force_N - e.load_cell_force_N);
  errors.observer_to_cell_N.add(e.contact_force_N - e.load_cell_force_N);
}

// A camera frame falls between two cycles, so the estimate is interpolated to its instant.
void add_motion_capture(const HopRow& before, const HopRow& row, EstimationErrors& errors) {
  if (row.truth.mocap_time_ns == before.truth.mocap_time_ns) return;
  errors.fresh_mocap += 1.0;
  const double share = seconds(row.truth.mocap_time_ns - before.truth.time_ns) / kCycle_s;
  const auto at_frame = [share](double then, double now) { return then + share * (now - then); };
  errors.foot_depth_m.add(at_frame(before.estimate.foot_z_m, row.estimate.foot_z_m) -
                          row.truth.mocap_foot_z_m);
  errors.body_height_m.add(at_frame(before.estimate.body_z_m, row.estimate.body_z_m) -
                           row.truth.mocap_body_z_m);
}

void add_innovations(const HopRow& row, EstimationErrors& errors) {
  for (std::size_t i = 0; i < errors.normalised_innovation.size(); ++i) {
    const double squared = row.estimate.normalised_innovation_squared[i];
    if (!std::isfinite(squared)) continue;
    errors.normalised_innovation[i].add(std::sqrt(squared));
    errors.innovations_below_384[i] += squared < kChiSquared95 ? 1.0 : 0.0;
  }
}

// True body height at an instant between the rows' times.
double body_z_at(const std::vector<HopRow>& rows, std::int64_t time_ns) {
  const auto after = std::find_if(rows.begin() + 1, rows.end() - 1,
                                  [time_ns](const HopRow& row) { return row.truth.time_ns >= time_ns; });
  const auto before = after - 1;
  const double share = seconds(time_ns - before->truth.time_ns) / kCycle_s;
  return before->truth.body_z_m + share * (after->truth.body_z_m - before->truth.body_z_m);
}

void add_tof(const HopTrial& trial, const StanceRows& at, EstimationErrors& errors) {
  double last_m = 0.0, last_true_m = 0.0;
  std::int64_t last_ns = 0;
  for (std::size_t i = at.contact; i < at.liftoff; ++i) {
    const auto& tof = trial.rows[i].tof;
    if (!tof.fresh) continue;
    errors.fresh_tof += 1.0;
    const double true_m = body_z_at(trial.rows, tof.time_ns);
    errors.tof_m.add(tof.height_m - true_m);
    if (last_ns != 0)
      errors.tof_velocity_mps.add(((tof.height_m - last_m) - (true_m - last_true_m)) /
                                  seconds(tof.time_ns - last_ns));
    last_m = tof.height_m;
    last_true_m = true_m;
    last_ns = tof.time_ns;
  }
}

}  // namespace

double SquareSum::rms() const { return std::sqrt(squares / count); }
double SquareSum::spread() const {
  return std::sqrt(std::max(0.0, squares / count - sum * sum / (count * count)));
}

void EstimationErrors::add(const EstimationErrors& other) {
  quasi_static_N.add(other.quasi_static_N);
  observer_N.add(other.observer_N);
  load_cell_N.add(other.load_cell_N);
  quasi_static_to_cell_N.add(other.quasi_static_to_cell_N);
  observer_to_cell_N.add(other.observer_to_cell_N);
  foot_depth_m.add(other.foot_depth_m);
  body_height_m.add(other.body_height_m);
  foot_velocity_mps.add(other.foot_velocity_mps);
  body_velocity_mps.add(other.body_velocity_mps);
  depth_about_trial_mean_m.add(other.depth_about_trial_mean_m);
  tof_m.add(other.tof_m);
  tof_velocity_mps.add(other.tof_velocity_mps);
  for (std::size_t i = 0; i < 3; ++i) {
    normalised_innovation[i].add(other.normalised_innovation[i]);
    innovations_below_384[i] += other.innovations_below_384[i];
  }
  cycles += other.cycles;
  fresh_load_cell += other.fresh_load_cell;
  fresh_tof += other.fresh_tof;
  fresh_mocap += other.fresh_mocap;
  longest_step_error_s = std::max(longest_step_error_s, other.longest_step_error_s);
}

EstimationErrors estimation_errors(const HopTrial& trial) {
  EstimationErrors errors;
  const auto at = stance_rows(trial);
  SquareSum depth_error_m;
  for (std::size_t i = at.contact; i < at.liftoff; ++i) {
    const auto& before = trial.rows[i - 1];
    const auto& row = trial.rows[i];
    add_forces(before, row, errors);
    add_motion_capture(before, row, errors);
    add_innovations(row, errors);
    errors.foot_velocity_mps.add(row.estimate.foot_velocity_mps - row.truth.foot_velocity_mps);
    errors.body_velocity_mps.add(row.estimate.body_velocity_mps - row.truth.body_velocity_mps);
    depth_error_m.add(row.estimate.foot_z_m - row.truth.foot_z_m);
    errors.cycles += 1.0;
    errors.fresh_load_cell += row.load_cell.fresh ? 1.0 : 0.0;
    errors.longest_step_error_s = std::max(
        errors.longest_step_error_s, std::abs(seconds(row.truth.time_ns - before.truth.time_ns - kCycle_ns)));
  }
  const double centre_m = depth_error_m.sum / depth_error_m.count;
  for (std::size_t i = at.contact; i < at.liftoff; ++i)
    errors.depth_about_trial_mean_m.add(trial.rows[i].estimate.foot_z_m - trial.rows[i].truth.foot_z_m -
                                        centre_m);
  add_tof(trial, at, errors);
  return errors;
}

}  // namespace sandhopper::paper
