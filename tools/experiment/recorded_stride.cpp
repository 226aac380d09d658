#include "tools/experiment/recorded_stride.hpp"

#include <cmath>

#include "tools/experiment/hopped_cycles.hpp"

namespace sandhopper {
namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000;

}  // namespace

RecordedStride record_stride(const CycleConfig& cycle, const WorldConfig& world_config,
                             const TrialSetup& setup, const StrideWatch& watch) {
  HoppedCycles hop(cycle, world_config, setup);
  RecordedStride stride;
  stride.foot = foot_in_flight(hop.controller().config(), Leg(cycle.robot));
  int cycles_left = watch.cycles_after_liftoff;
  bool more = true;
  while (more) {
    more = hop.next(watch.before_cycle);
    const auto& out = hop.output();
    if (watch.on_cycle) watch.on_cycle({hop.frame(), out, hop.truth()});
    if (!more || (stride.complete && cycles_left-- <= 0)) return stride;
    if (stride.complete) continue;
    const auto& before = hop.truth_before();
    if (out.state != State::armed || out.command.open_catch)
      stride.samples.push_back({out.estimate, out.state, before.contact_force_N, before.foot_z_m,
                                before.foot_velocity_mps, before.foot_accel_mps2,
                                hop.truth().contact_force_N});
    stride.complete = hop.controller().stride_finished();
    if (stride.complete && cycles_left == 0) return stride;
  }
  return stride;
}

RecordedStride with_true_state(const RecordedStride& stride) {
  RecordedStride truth = stride;
  for (auto& sample : truth.samples) {
    auto& estimate = sample.estimate;
    estimate.contact_force_N = sample.true_force_N;
    estimate.direct_force_N = sample.true_force_N;
    estimate.force_depth_m = -sample.true_foot_z_m;
    estimate.force_velocity_mps = -sample.true_foot_velocity_mps;
    estimate.foot_z_m = sample.true_foot_z_m;
    estimate.foot_velocity_mps = sample.true_foot_velocity_mps;
    estimate.weighting_accel_mps2 = std::abs(sample.true_foot_accel_mps2);
  }
  return truth;
}

RecordedStride paired_by_row(const RecordedStride& stride) {
  RecordedStride paired = stride;
  for (auto& sample : paired.samples) {
    sample.estimate.force_depth_m = -sample.estimate.foot_z_m;
    sample.estimate.force_velocity_mps = -sample.estimate.foot_velocity_mps;
  }
  return paired;
}

void follow_strides(std::span<const RecordedStride> strides, const StiffnessConfig& config,
                    const std::function<void(const StrideSums&)>& at_liftoff) {
  if (strides.empty()) return;
  StrideRecorder recorder(config, strides.front().foot);
  State state = State::armed;
  for (const auto& stride : strides)
    for (const auto& sample : stride.samples) {
      const std::int64_t now_ns = sample.estimate.force_time_ns + kPeriod_ns;
      // The sample of a cycle belongs to the state before the cycle's transition.
      if (state != State::armed) recorder.update(sample.estimate, state);
      if (state == State::armed && sample.state == State::flight) recorder.on_release(now_ns);
      if (state == State::flight && sample.state == State::compression) recorder.on_touchdown(now_ns);
      if (state == State::compression && sample.state == State::extension) recorder.on_switch(now_ns);
      const bool liftoff = state == State::extension && sample.state == State::flight;
      if (liftoff) recorder.on_liftoff(now_ns);
      state = sample.state;
      if (liftoff) at_liftoff(recorder.sums());
    }
}

StrideSums stride_sums(const RecordedStride& stride, const StiffnessConfig& config) {
  StrideSums sums;
  follow_strides({&stride, 1}, config, [&](const StrideSums& done) { sums = done; });
  return sums;
}

StrideResult evaluate_stride(const RecordedStride& stride, const StiffnessConfig& config) {
  return solve_stride(stride_sums(stride, config), config);
}

}  // namespace sandhopper
