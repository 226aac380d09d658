#include "tools/experiment/bed_strides.hpp"

#include <algorithm>
#include <utility>

#include "tools/plant/trial_draw.hpp"

namespace sandhopper {
namespace {

constexpr int kCyclesAfterLiftoff = 150;  // a leaving foot is clear of its crater by then

BedCase power(const char* name, double exponent) {
  BedCase bed{name, bed_family_of(BedFamily::power_law)};
  bed.family.exponent = exponent;
  bed.family.exponent_spread = 0.0;
  return bed;
}

BedCase of(BedFamily family, bool smooth) {
  return {std::string(name_of(family)), bed_family_of(family), smooth};
}

std::vector<BedCase> make_cases() {
  std::vector<BedCase> cases{of(BedFamily::line, true),
                             power("power_0.8", 0.8),
                             power("power_1.1", 1.1),
                             power("power_1.4", 1.4),
                             power("power_1.8", 1.8),
                             of(BedFamily::compacted, true),
                             of(BedFamily::gradually_denser, true),
                             of(BedFamily::soft_over_stiff, false),
                             of(BedFamily::stiff_over_soft, false),
                             of(BedFamily::crust, false),
                             of(BedFamily::crust, false),
                             of(BedFamily::wet, false),
                             of(BedFamily::line, false)};
  auto& surface = cases[10];
  surface.name = "crust_at_surface";
  surface.family.crust_depth_m = 0.0;
  surface.family.depth_spread_m = 0.0;
  auto& box = cases[12];
  box.name = "box_with_floor";
  box.family.floor_depth_m = 0.030;
  box.family.depth_spread_m = 0.002;
  return cases;
}

// Cuts a stride's cycles down to what the ground did to the foot.
class SampleCutter {
 public:
  SampleCutter(const StiffnessConfig& config, BedStride& stride) : config_(config), stride_(stride) {}

  void see(const CycleView& view) {
    const auto& e = view.output.estimate;
    const State before = state_;
    state_ = view.output.state;
    const auto previous_ns = std::exchange(last_ns_, e.force_time_ns);
    if (left_) return;
    stride_.true_max_depth_m = std::max(stride_.true_max_depth_m, view.truth.max_depth_m);
    if (before != State::flight && before != State::compression && before != State::extension) return;
    if (contact_ns_ == 0) {
      if (e.direct_force_N < config_.contact_force_N) return;
      contact_ns_ = e.force_time_ns;
      datum_m_ = e.force_depth_m;
      stride_.contact_error_m = std::max(0.0, -view.truth.foot_z_m);
    }
    const double since_contact_s = 1e-9 * static_cast<double>(e.force_time_ns - contact_ns_);
    if (before != State::flight && before != state_) stride_.phase_changes_s.push_back(since_contact_s);
    const double depth = e.force_depth_m - datum_m_;
    lifted_ = lifted_ || (before == State::extension && state_ == State::flight);
    rises_ = rises_ || (lifted_ && e.force_velocity_mps < -config_.min_speed_mps);
    left_ = rises_ && (depth < 0.0 || e.force_velocity_mps > 0.0);  // clear of the surface, or falling again
    if (left_) return;
    stride_.samples.push_back({.depth_m = depth,
                               .speed_mps = e.force_velocity_mps,
                               .accel_mps2 = -e.foot_accel_mps2,
                               .force_N = e.direct_force_N,
                               .leg_rate_mps = e.leg_rate_mps,
                               .since_contact_s = since_contact_s,
                               .duration_s = 1e-9 * static_cast<double>(e.force_time_ns - previous_ns)});
  }

 private:
  const StiffnessConfig& config_;
  BedStride& stride_;
  State state_ = State::idle;
  std::int64_t last_ns_ = 0, contact_ns_ = 0;
  double datum_m_ = 0.0;
  bool lifted_ = false, rises_ = false, left_ = false;
};

}  // namespace

const std::vector<BedCase>& bed_cases() {
  static const std::vector<BedCase> cases = make_cases();
  return cases;
}

BedStride run_bed_stride(const CycleConfig& base, const WorldConfig& world_config, const BedCase& bed,
                         std::uint64_t seed) {
  const auto& cells = hop_cells();
  const auto& cell = cells[(seed - 1) % cells.size()];
  CycleConfig cycle = base;
  cycle.controller.compression_stiffness_N_per_m = cell.compression_stiffness_N_per_m;
  WorldConfig world = world_config;
  world.bed_family = bed.family;
  BedStride stride;
  stride.truth = bed_truth_of(TrialDraw(world, {.seed = seed, .noise = true, .start_ns = 0}).bed());
  SampleCutter cutter(cycle.stiffness, stride);
  StrideWatch watch;
  watch.on_cycle = [&](const CycleView& view) { cutter.see(view); };
  watch.cycles_after_liftoff = kCyclesAfterLiftoff;
  const auto recorded = record_stride(
      cycle, world, {.release_height_m = cell.release_height_m, .seed = seed, .noise = true}, watch);
  stride.complete = recorded.complete;
  if (stride.complete) {
    const auto sums = stride_sums(recorded, cycle.stiffness);
    stride.result = solve_stride(sums, cycle.stiffness);
    stride.profile = sums.profile;
  }
  return stride;
}

}  // namespace sandhopper
