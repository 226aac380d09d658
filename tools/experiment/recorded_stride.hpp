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

// One cycle of a simulated stride: the firmware's estimate and the true values, both at the instant of the
// forces (Estimate::force_time_ns).
struct StrideSample {
  Estimate estimate;
  State state;
  double true_force_N;
  double true_foot_z_m;
  double true_foot_velocity_mps;
  double true_foot_accel_mps2;
  double true_force_now_N;  // at the time of the cycle
};

// First stride of a trial from release to liftoff, run by the firmware's own Controller on the simulated
// board.
struct RecordedStride {
  std::vector<StrideSample> samples;
  StrideRecorder::Foot foot{};
  bool complete = false;  // liftoff was reached without a fault
};

// Input and output of a cycle and the true values at its time. Valid during the call.
struct CycleView {
  const SensorFrame& frame;
  const StepOutput& output;
  const PlantTruth& truth;
};

// Hooks for every cycle, including those before the release and some after liftoff: on_cycle observes,
// before_cycle may change the controller's input.
struct StrideWatch {
  std::function<void(SensorFrame&)> before_cycle{};
  std::function<void(const CycleView&)> on_cycle{};
  int cycles_after_liftoff = 0;
};

RecordedStride record_stride(const CycleConfig& cycle, const WorldConfig& world, const TrialSetup& setup,
                             const StrideWatch& watch = {});

// The same stride with perfect sensors and a perfect observer. The quasi-static force is still calculated
// from the motors' currents.
RecordedStride with_true_state(const RecordedStride& stride);

// The same stride for an analysis that treats all values of a row as simultaneous: the forces are paired with
// the newest depth and speed, which are one cycle younger.
RecordedStride paired_by_row(const RecordedStride& stride);

// Evaluates the strides of one hop in order with one recorder, which keeps the crater of earlier strides.
void follow_strides(std::span<const RecordedStride> strides, const StiffnessConfig& config,
                    const std::function<void(const StrideSums&)>& at_liftoff);

// Evaluates the same stride with another sample window, intercept or weights. The result is bit for bit that
// of the firmware with that configuration.
StrideSums stride_sums(const RecordedStride& stride, const StiffnessConfig& config);
StrideResult evaluate_stride(const RecordedStride& stride, const StiffnessConfig& config);

}  // namespace sandhopper
