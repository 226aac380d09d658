#include "tools/experiment/bed_strides.hpp"

#include <algorithm>
#include <stdexcept>

#include "tools/experiment/hopped_cycles.hpp"
#include "tools/plant/trial_draw.hpp"

namespace sandhopper {
namespace {

BedCase power(const char* name, double exponent, bool standard) {
  BedCase bed{name, bed_family_of(BedFamily::power_law), standard};
  bed.family.exponent = exponent;
  bed.family.exponent_spread = 0.0;
  return bed;
}

BedCase crust_at_surface() {
  BedCase bed{"crust_at_surface", bed_family_of(BedFamily::crust), false};
  bed.family.crust_depth_m = 0.0;
  bed.family.depth_spread_m = 0.0;
  return bed;
}

BedCase box_with_floor() {
  BedCase bed{"box_with_floor", bed_family_of(BedFamily::line), false};
  bed.family.floor_depth_m = 0.030;
  bed.family.depth_spread_m = 0.002;
  return bed;
}

std::vector<BedCase> make_cases() {
  std::vector<BedCase> cases;
  for (const auto family :
       {BedFamily::line, BedFamily::power_law, BedFamily::soft_over_stiff, BedFamily::stiff_over_soft,
        BedFamily::crust, BedFamily::compacted, BedFamily::wet, BedFamily::gradually_denser})
    cases.push_back({std::string(name_of(family)), bed_family_of(family)});
  cases.push_back(power("power_1.4", 1.4, true));
  for (const auto& [name, exponent] : {std::pair{"power_0.8", 0.8}, {"power_1.1", 1.1}, {"power_1.8", 1.8}})
    cases.push_back(power(name, exponent, false));
  cases.push_back(crust_at_surface());
  cases.push_back(box_with_floor());
  return cases;
}

// Depth errors of a first stride, one for each length over which a bed's fluctuation is correlated.
class DepthErrorRecorder {
 public:
  DepthErrorRecorder(double spacing_m, StrideDepthErrors& errors) : spacing_m_(spacing_m), errors_(errors) {}

  void on_contact(const Estimate& e) {
    contact_ns_ = e.force_time_ns;
    contact_mps_ = e.force_velocity_mps;
  }
  void add(const Estimate& e, double depth_m, double true_depth_m) {
    if (depth_m < next_m_) return;
    next_m_ = depth_m + spacing_m_;
    errors_.push_back({1e-9 * static_cast<double>(e.force_time_ns - contact_ns_),
                       e.force_velocity_mps - contact_mps_, true_depth_m - depth_m});
  }

 private:
  double spacing_m_;
  StrideDepthErrors& errors_;
  double next_m_ = 1e-9;
  std::int64_t contact_ns_ = 0;
  double contact_mps_ = 0.0;
};

}  // namespace

const std::vector<BedCase>& bed_cases() {
  static const std::vector<BedCase> cases = make_cases();
  return cases;
}

std::vector<BedCase> named_bed_cases(const std::vector<std::string>& names) {
  std::vector<BedCase> cases;
  for (const auto& bed : bed_cases()) {
    const bool named = std::ranges::find(names, bed.name) != names.end();
    if (named || (names.empty() && bed.standard)) cases.push_back(bed);
  }
  for (const auto& name : names)
    if (std::ranges::find(cases, name, &BedCase::name) == cases.end())
      throw std::invalid_argument("no bed '" + name + "'");
  return cases;
}

WorldConfig with_drop_scatter(WorldConfig world) {
  constexpr double kDropHeight_sd_m = 0.0005;
  world.spread.release_height_m = kDropHeight_sd_m;
  return world;
}

BedTrial run_bed_trial(const CycleConfig& base, const WorldConfig& world_config, const BedCase& bed,
                       std::uint64_t seed, int strides, std::optional<std::uint64_t> robot_seed) {
  const auto& cells = hop_cells();
  const auto& cell = cells[(seed - 1) % cells.size()];
  CycleConfig cycle = base;
  cycle.controller.compression_stiffness_N_per_m = cell.compression_stiffness_N_per_m;
  cycle.limits.strides = strides;
  WorldConfig world = with_drop_scatter(world_config);
  world.bed_family = bed.family;
  BedTrial trial;
  trial.truth = bed_truth_of(TrialDraw(world, {.seed = seed, .noise = true, .start_ns = 0}).bed());
  bool touched = false;
  HoppedCycles hop(
      cycle, world,
      {.release_height_m = cell.release_height_m, .seed = seed, .noise = true, .robot_seed = robot_seed},
      kHang_cycles);
  DepthErrorRecorder errors(cycle.stiffness.joint.fluctuation_length_m, trial.depth_errors);
  double crater_m = 0.0;
  std::optional<double> new_ground_error_m;
  while (hop.next()) {
    const auto& controller = hop.controller();
    const auto& truth = hop.truth();
    if (!touched && hop.output().estimate.direct_force_N >= cycle.stiffness.contact_force_N &&
        hop.output().state == State::flight) {
      touched = true;
      errors.on_contact(hop.output().estimate);
      trial.contact_error_m = std::max(0.0, -truth.foot_z_m);
    }
    if (touched && trial.strides.empty())
      errors.add(hop.output().estimate, controller.new_ground_m(), -hop.truth_before().foot_z_m);
    if (controller.new_ground_m() > 0.0 && !new_ground_error_m)
      new_ground_error_m = controller.new_ground_m() + hop.truth_before().foot_z_m;
    if (controller.stride_finished()) {
      auto& stride = trial.strides.emplace_back(BedStride{
          .sums = controller.stride_sums(), .true_crater_m = crater_m, .true_deepest_m = truth.max_depth_m});
      if (new_ground_error_m && trial.strides.size() > 1)
        stride.landing_error_m = *new_ground_error_m - (stride.sums.summary.crater_depth_m - crater_m);
      new_ground_error_m.reset();
      crater_m = truth.max_depth_m;
    }
    if (controller.ground_events_complete() && !trial.strides.empty()) {
      trial.strides.back().events = controller.ground_event_sums();
      trial.strides.back().events_complete = true;
      if (static_cast<int>(trial.strides.size()) == strides) break;
    }
  }
  return trial;
}

}  // namespace sandhopper
