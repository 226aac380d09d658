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
//   after limits.strides liftoffs, or on request, the next touchdown is a soft stop, then idle; a stance that
//   comes to rest, too; any fault, in
//   any state: fault state, by way of the reaction that the fault's entry names, left only by `disarm` and
//   only where the entry's latching rule allows it.
class Controller {
 public:
  // Throws std::invalid_argument where the configuration describes no leg.
  explicit Controller(const CycleConfig& config);
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;

  const StepOutput& step(const SensorFrame& frame) noexcept;

  // Events of the last step, oldest first.
  std::span<const Event> events() const noexcept { return {events_.data(), event_count_}; }
  // Whether the last step finished a stride; its sums then.
  bool stride_finished() const noexcept { return stride_finished_; }
  const StrideSums& stride_sums() const noexcept { return recorder_.sums(); }
  // True where the foot has just left its crater: what the ground did to it in the stride before is complete.
  bool ground_events_complete() const noexcept { return recorder_.foot_is_clear() && hopping_; }
  // Estimated depth of the foot on new ground in the present stride; zero before it is reached.
  double new_ground_m() const noexcept { return recorder_.new_ground_m(); }
  const GroundEventSums& ground_event_sums() const noexcept { return recorder_.event_sums(); }
  // Whether the last step's request meant anything in the state the robot was in.
  bool request_had_effect() const noexcept { return request_had_effect_; }
  const CycleConfig& config() const noexcept { return config_; }
  const ThermalModel& thermal(std::size_t motor) const noexcept { return supervisor_.thermal(motor); }
  // Since the leg was inspected, earlier runs included.
  std::uint32_t touchdowns() const noexcept { return config_.start.touchdowns + recorder_.strides_begun(); }

  // For tests of the tests: without this fault's detector.
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
  double body_bias_mps2_ = 0.0;  // of the body's accelerometer, measured while arming
  bool ready_ = false;           // armed and checked
  bool stop_requested_ = false;
  bool stride_finished_ = false;
  bool hopping_ = false;  // in the last step the recorder was updated
  bool request_had_effect_ = false;
  bool fault_of_last_run_ = false;
  std::array<double, 2> fault_values_{};
};

}  // namespace sandhopper
