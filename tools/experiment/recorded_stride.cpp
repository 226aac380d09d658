#include "tools/experiment/recorded_stride.hpp"

#include <cmath>

#include "firmware/controller.hpp"
#include "tools/plant/sim_board.hpp"

namespace sandhopper {
namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000;
constexpr std::int64_t kLongest_cycles = 5000;

}  // namespace

RecordedStride record_stride(const CycleConfig& cycle, const WorldConfig& world_config,
                             const TrialSetup& setup, const StrideWatch& watch) {
  World world(world_config, setup, 0);
  SimBoard board(world);
  Controller controller(cycle);
  SensorFrame frame;
  RecordedStride stride;
  stride.foot = foot_in_flight(controller.config(), Leg(cycle.robot));
  PlantTruth truth{};
  Request request = Request::arm;
  int cycles_left = watch.cycles_after_liftoff;
  for (std::int64_t k = 1; k < kLongest_cycles; ++k) {
    frame.time_ns = k * kPeriod_ns;
    frame.cycle = static_cast<std::uint64_t>(k);
    frame.request = request;
    request = Request::none;
    const PlantTruth before = truth;  // at the instant of the newest motor reply: the previous cycle's
    board.read(frame);
    truth = world.truth();
    SensorFrame told = frame;
    if (watch.before_cycle) watch.before_cycle(told);
    const auto& out = controller.step(told);
    board.write(out.command);
    if (watch.on_cycle) watch.on_cycle({told, out, truth});
    for (const auto& event : controller.events())
      if (event.kind == EventKind::armed) request = Request::release;
    if (out.state == State::fault || (out.state == State::idle && k > 1)) return stride;
    if (stride.complete && cycles_left-- <= 0) return stride;
    if (stride.complete) continue;
    if (out.state != State::armed || out.command.open_catch)
      stride.samples.push_back({out.estimate, out.state, before.contact_force_N, before.foot_z_m,
                                before.foot_velocity_mps, before.foot_accel_mps2, truth.contact_force_N});
    stride.complete = controller.stride_finished();
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
      // A cycle's sample belongs to the state before its transition.
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
