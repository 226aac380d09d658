#include "tools/experiment/paper/hop_trial.hpp"

namespace sandhopper::paper {

namespace {

constexpr int kCyclesAfterLiftoff = 30;

}  // namespace

HopTrial run_hop(const CycleConfig& base, const WorldConfig& world, const HopCell& cell,
                 const TrialSetup& setup) {
  CycleConfig cycle = base;
  cycle.controller.compression_stiffness_N_per_m = cell.compression_stiffness_N_per_m;
  TrialSetup released = setup;
  released.release_height_m = cell.release_height_m;

  HopTrial trial{.cell = cell, .stride = {}, .rows = {}};
  PlantTruth before{};
  std::int64_t release_ns = 0;
  const auto watch = [&](const CycleView& view) {
    if (view.truth.released) {
      if (trial.rows.empty()) release_ns = before.time_ns;
      trial.rows.push_back(
          {.time_s = 1e-9 * static_cast<double>(view.truth.time_ns - release_ns),
           .state = view.output.state,
           .estimate = view.output.estimate,
           .truth = view.truth,
           .tof = view.frame.tof,
           .load_cell = view.frame.load_cell,
           .mean_force_N = (view.truth.contact_impulse_Ns - before.contact_impulse_Ns) / kCycle_s,
           .mean_accel_mps2 = (view.truth.foot_velocity_mps - before.foot_velocity_mps) / kCycle_s});
    }
    before = view.truth;
  };
  trial.stride =
      record_stride(cycle, world, released, {.on_cycle = watch, .cycles_after_liftoff = kCyclesAfterLiftoff});
  trial.complete = trial.stride.complete;
  return trial;
}

StanceRows stance_rows(const HopTrial& trial) {
  const auto& rows = trial.rows;
  const auto first = [&](std::size_t from, auto&& holds) {
    while (from < rows.size() && !holds(rows[from])) ++from;
    return from;
  };
  const auto contact = first(0, [](const HopRow& row) { return row.truth.foot_z_m <= 0.0; });
  const auto change = first(contact, [](const HopRow& row) { return row.state == State::extension; });
  const auto liftoff = first(change, [](const HopRow& row) { return row.state == State::flight; });
  return {contact, change, liftoff};
}

}  // namespace sandhopper::paper
