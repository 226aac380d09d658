#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "firmware/controller_config.hpp"
#include "firmware/records.hpp"
#include "firmware/sensor_frame.hpp"
#include "firmware/stride_recorder.hpp"
#include "tools/plant/world.hpp"

namespace sandhopper {

// One cycle of a simulated stride: what the firmware believed and what was true, both at the instant the
// forces belong to (Estimate::force_time_ns).
struct StrideSample {
  Estimate estimate;
  State state;
  double true_force_N;
  double true_foot_z_m;
  double true_foot_velocity_mps;
  double true_foot_accel_mps2;
  double true_force_now_N;  // at the cycle's own time
};

// The first stride of a trial run by the firmware's own Controller on the simulated board, release to
// liftoff.
struct RecordedStride {
  std::vector<StrideSample> samples;
  StrideRecorder::Foot foot{};
  bool complete = false;  // liftoff was reached without a fault
};

// What a cycle read and did, and what was true at its time; valid during the call.
struct CycleView {
  const SensorFrame& frame;
  const StepOutput& output;
  const PlantTruth& truth;
};

// Who wants to see every cycle, also those before the release and some after the liftoff, or to change what
// the controller is told.
struct StrideWatch {
  std::function<void(SensorFrame&)> before_cycle{};
  std::function<void(const CycleView&)> on_cycle{};
  int cycles_after_liftoff = 0;
};

RecordedStride record_stride(const CycleConfig& cycle, const WorldConfig& world, const TrialSetup& setup,
                             const StrideWatch& watch = {});

// The same stride as perfect sensors and a perfect observer would have told it; the quasi-static force
// remains what the motors' currents say.
RecordedStride with_true_state(const RecordedStride& stride);

// The same stride for an analysis that takes a row's figures as of one instant: its forces stand beside the
// newest depth and speed, which are a cycle younger.
RecordedStride paired_by_row(const RecordedStride& stride);

// The strides of one hop, one after the other, through one recorder, which knows the crater of those before.
void follow_strides(std::span<const RecordedStride> strides, const StiffnessConfig& config,
                    const std::function<void(const StrideSums&)>& at_liftoff);

// The same stride evaluated with another sample window, intercept or weights: bit for bit what the firmware
// would have said with that configuration.
StrideSums stride_sums(const RecordedStride& stride, const StiffnessConfig& config);
StrideResult evaluate_stride(const RecordedStride& stride, const StiffnessConfig& config);

}  // namespace sandhopper
