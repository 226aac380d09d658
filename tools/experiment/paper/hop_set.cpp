#include "tools/experiment/paper/hop_set.hpp"

#include "tools/experiment/parallel.hpp"
#include "tools/experiment/statistics.hpp"

namespace sandhopper::paper {
namespace {

// Linearity of force over estimated depth while the foot penetrates.
void find_linearity(const HopTrial& trial, double min_speed_mps, HopResult& result) {
  std::vector<double> depth_m, quasi_static_N, observer_N;
  const auto at = stance_rows(trial);
  for (std::size_t i = at.contact + 1; i < at.liftoff; ++i) {
    const auto& e = trial.rows[i].estimate;
    if (e.force_velocity_mps < min_speed_mps) continue;
    depth_m.push_back(e.force_depth_m);
    quasi_static_N.push_back(e.quasi_static_force_N);
    observer_N.push_back(e.contact_force_N);
  }
  if (depth_m.size() < 3) return;
  result.quasi_static_r_squared = fit_line(depth_m, quasi_static_N).r_squared;
  result.observer_r_squared = fit_line(depth_m, observer_N).r_squared;
}

HopResult run_one(const HopSetSetup& setup, const ForceMap& map, std::size_t cell, std::uint64_t seed) {
  const auto trial = run_hop(setup.cycle, setup.world, hop_cells()[cell], {.seed = seed});
  HopResult result{.cell = cell, .complete = trial.complete};
  if (!trial.complete) return result;
  result.shape = stride_shape(trial);
  result.errors = estimation_errors(trial);
  result.truth = decompose(penetrating_samples(trial, map, ForceSource::truth));
  result.instruments = decompose(penetrating_samples(trial, map, ForceSource::instruments));
  result.robot = decompose(penetrating_samples(trial, map, ForceSource::robot));
  find_linearity(trial, setup.cycle.stiffness.min_speed_mps, result);
  result.validity = evaluate_stride(trial.stride, setup.cycle.stiffness).observer_ols.validity;
  return result;
}

}  // namespace

std::vector<HopResult> run_hop_set(const HopSetSetup& setup, const ForceMap& map) {
  const int per_seed = static_cast<int>(hop_cells().size()) * setup.trials_per_cell;
  const int total = setup.seeds * per_seed;
  std::vector<HopResult> results(static_cast<std::size_t>(total));
  const auto work = [&](long i) {
    const auto cell = static_cast<std::size_t>(i % per_seed / setup.trials_per_cell);
    results[static_cast<std::size_t>(i)] = run_one(setup, map, cell, static_cast<std::uint64_t>(i + 1));
  };
  const auto report = [&setup](long done, long all) {
    if (setup.progress) setup.progress(static_cast<int>(done), static_cast<int>(all));
  };
  parallel_for(total, setup.threads, work, report);
  return results;
}

}  // namespace sandhopper::paper
