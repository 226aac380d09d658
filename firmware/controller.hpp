#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "estimation/leg.hpp"
#include "firmware/arming.hpp"
#include "firmware/controller_config.hpp"
#include "firmware/fault_reaction.hpp"
#include "firmware/gait.hpp"
#include "firmware/records.hpp"
#include "firmware/robot_estimator.hpp"
#include "firmware/sensor_frame.hpp"
#include "firmware/stride_recorder.hpp"
#include "firmware/supervision/supervisor.hpp"

namespace sandhopper {

// The cycle: sensors in, command out. Pure: reads no clock, does no I/O, allocates nothing, throws nothing,
// and gives the same bits for the same frames.
//
//   idle --arm--> armed (zero check) --free fall--> flight --> compression --> extension --> flight --> ...
// After limits.strides liftoffs, or on request, the next touchdown begins a soft stop, then idle. A stance
// that comes to rest also ends so. A fault in any state leads through the reaction in its entry to the fault
// state. Only `disarm` leaves it, and only if the entry's latch allows it.
class Controller {
 public:
  // Throws std::invalid_argument if the configuration does not describe a leg.
  explicit Controller(const CycleConfig& config);
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;

  const StepOutput& step(const SensorFrame& frame) noexcept;

  // Events of the last step, oldest first.
  std::span<const Event> events() const noexcept { return {events_.data(), event_count_}; }
  // True if the last step finished a stride. Its sums are then in stride_sums().
  bool stride_finished() const noexcept { return stride_finished_; }
  const StrideSums& stride_sums() const noexcept { return recorder_.sums(); }
  // True if the foot has just left its crater: the ground events of the previous stride are complete.
  bool ground_events_complete() const noexcept { return recorder_.foot_is_clear() && hopping_; }
  // Estimated depth of the foot on new ground in this stride; 0 before it reaches new ground.
  double new_ground_m() const noexcept { return recorder_.new_ground_m(); }
  const GroundEventSums& ground_event_sums() const noexcept { return recorder_.event_sums(); }
  // True if the last step's request had an effect in the robot's state.
  bool request_had_effect() const noexcept { return request_had_effect_; }
  const CycleConfig& config() const noexcept { return config_; }
  const ThermalModel& thermal(std::size_t motor) const noexcept { return supervisor_.thermal(motor); }
  // Number since the leg was inspected, including earlier runs.
  std::uint32_t touchdowns() const noexcept { return config_.start.touchdowns + recorder_.strides_begun(); }

  // Removes this fault's detector. For tests that prove that the fault matrix notices a missing detector.
  void switch_off(Fault detector) noexcept { supervisor_.switch_off(detector); }

 private:
  bool serve_request(const SensorFrame& frame) noexcept;
  void supervise(const SensorFrame& frame) noexcept;
  void step_armed(const SensorFrame& frame) noexcept;
  void step_hop(const SensorFrame& frame) noexcept;
  void step_soft_stop(const SensorFrame& frame) noexcept;
  void apply(const Transition& transition, const SensorFrame& frame) noexcept;
  void enter(State state, const SensorFrame& frame) noexcept;
  void raise(const FaultFound& found, const SensorFrame& frame) noexcept;
  bool disarm(const SensorFrame& frame) noexcept;
  bool estimating() const noexcept;
  bool still() const noexcept;
  void emit(EventKind kind, Reason reason, const std::array<double, 4>& values) noexcept;
  void write_command(const SensorFrame& frame) noexcept;
  LegObservation observation() const noexcept;
  double time_in_state_s(const SensorFrame& frame) const noexcept;
  double phase_time_s(const SensorFrame& frame) const noexcept;

  const CycleConfig config_;
  const Leg leg_;
  RobotEstimator estimator_;
  Arming arming_;
  StrideRecorder recorder_;
  Supervisor supervisor_;
  FaultReaction reaction_;
  StepOutput out_{};
  std::array<Event, 8> events_{};
  std::size_t event_count_ = 0;
  std::int64_t state_since_ns_ = 0;
  std::int64_t still_since_ns_ = 0;
  int free_fall_count_ = 0;
  double body_bias_mps2_ = 0.0;  // bias of the body's accelerometer, measured while arming
  bool ready_ = false;           // armed and checked
  bool stop_requested_ = false;
  bool stride_finished_ = false;
  bool hopping_ = false;  // the recorder was updated in the last step
  bool request_had_effect_ = false;
  // The latched fault was restored from the last run's memory.
  bool fault_of_last_run_ = false;
  std::array<double, 2> fault_values_{};
};

}  // namespace sandhopper
