#include "tools/experiment/paper/decomposition.hpp"

#include "tools/experiment/statistics.hpp"

namespace sandhopper::paper {
namespace {

constexpr std::size_t kFewest = 10;

// Sample of one row for this source. The previous row contains the motion at the instant of the estimate's
// forces.
PenetratingSample sample_of(const HopRow& before, const HopRow& row, const ForceMap& map,
                            ForceSource source) {
  PenetratingSample s{};
  double accel_mps2 = 0.0;
  if (source == ForceSource::robot) {
    s.depth_m = row.estimate.force_depth_m;
    s.speed_mps = row.estimate.force_velocity_mps;
    s.force_N = row.estimate.contact_force_N;
    accel_mps2 = before.estimate.foot_accel_mps2;
  } else {
    s.depth_m = -row.truth.foot_z_m;
    s.speed_mps = -row.truth.foot_velocity_mps;
    s.force_N = source == ForceSource::truth ? row.truth.contact_force_N : row.estimate.load_cell_force_N;
    accel_mps2 = row.truth.foot_accel_mps2;
  }
  s.map_N = map.force_N(s.depth_m, s.speed_mps);
  s.inertia_N = -map.added_mass_kg(s.depth_m) * accel_mps2;
  return s;
}

// Depth estimated by the filter when the foot's accelerometer first measures the ground's force. The robot
// takes this point as zero depth. Calculated as the value after the last cycle before touchdown without
// contact force.
double met_surface_at_m(const HopTrial& trial) {
  const double contact_force_N = StiffnessConfig{}.contact_force_N;
  double depth_m = 0.0;
  for (const auto& row : trial.rows) {
    if (row.estimate.direct_force_N < contact_force_N) depth_m = row.estimate.force_depth_m;
    if (row.state == State::compression) break;
  }
  return depth_m;
}

}  // namespace

std::vector<PenetratingSample> penetrating_samples(const HopTrial& trial, const ForceMap& map,
                                                   ForceSource source) {
  const auto at = stance_rows(trial);
  const double datum_m = source == ForceSource::robot ? met_surface_at_m(trial) : 0.0;
  std::vector<PenetratingSample> samples;
  std::vector<double> depth_m, force_N;
  double deepest_m = 0.0;
  for (std::size_t i = at.contact + 1; i < at.liftoff; ++i) {
    auto s = sample_of(trial.rows[i - 1], trial.rows[i], map, source);
    if (source == ForceSource::robot) s.depth_m -= datum_m;
    if (!(s.depth_m > deepest_m && s.speed_mps > 0.0)) continue;
    deepest_m = s.depth_m;
    s.map_N = map.force_N(s.depth_m, s.speed_mps);
    s.time_s = trial.rows[i].time_s - trial.rows[at.contact].time_s;
    samples.push_back(s);
    depth_m.push_back(s.depth_m);
    force_N.push_back(s.force_N);
  }
  if (samples.size() < kFewest) return {};
  const auto line = fit_line(depth_m, force_N);
  for (auto& s : samples) s.line_N = line.intercept + line.slope * s.depth_m;
  return samples;
}

Decomposition decompose(const std::vector<PenetratingSample>& samples) {
  if (samples.empty()) return {};
  std::vector<double> line, map, both, inertia;
  for (const auto& s : samples) {
    line.push_back(s.force_N - s.line_N);
    map.push_back(s.force_N - s.map_N);
    both.push_back(s.force_N - s.map_N - s.inertia_N);
    inertia.push_back(s.inertia_N);
  }
  return {rms(line), rms(map), rms(both), correlation(map, inertia), true};
}

}  // namespace sandhopper::paper
