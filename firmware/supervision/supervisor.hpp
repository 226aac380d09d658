#pragma once
#include <array>

#include "firmware/controller_config.hpp"
#include "firmware/records.hpp"
#include "firmware/sensor_frame.hpp"
#include "firmware/supervision/bus_check.hpp"
#include "firmware/supervision/cycle_check.hpp"
#include "firmware/supervision/findings.hpp"
#include "firmware/supervision/motion_check.hpp"
#include "firmware/supervision/motor_check.hpp"
#include "firmware/supervision/sensor_check.hpp"

namespace sandhopper {

// Checks every frame in every state and returns the fault it shows, if any; of several the one with the
// harshest reaction. It stores the history that the checks need, so it must see each frame exactly once.
// Being part of the cycle it reads no clock and neither allocates nor throws.
class Supervisor {
 public:
  // `config` and `leg` must outlive it.
  Supervisor(const CycleConfig& config, const Leg& leg) noexcept;

  struct Context {
    State state;
    double phase_time_s;  // time in flight, compression or extension; for a soft stop the time beyond its
                          // planned duration
    bool estimating;      // the estimate belongs to this frame
    bool energised;       // drives are on and checked
    std::uint32_t touchdowns;  // since the leg was inspected
    const Command& command;    // of the last cycle
  };
  FaultFound check(const SensorFrame& frame, const Estimate& estimate, const Context& context) noexcept;

  const ThermalModel& thermal(std::size_t motor) const noexcept { return motor_[motor].thermal(); }

  // Removes this fault's detector. For tests that prove that the fault matrix notices a missing detector.
  void switch_off(Fault detector) noexcept { off_.set(static_cast<std::size_t>(detector)); }

 private:
  void check_motors(const SensorFrame& frame, const Context& context, std::int64_t cycles,
                    Findings& findings) noexcept;
  void check_sensors(const SensorFrame& frame, const Context& context, Findings& findings) noexcept;

  const CycleConfig& config_;
  DetectorMask off_;
  CycleCheck cycle_;
  BusCheck bus_;
  std::array<MotorCheck, kMotorCount> motor_;
  MotorPairCheck motor_pair_;
  std::array<SensorCheck, 4> sensor_;  // body IMU, foot IMU, ToF, load cell
  MotionCheck motion_;
  SensorFrame last_{};
  std::int64_t first_ns_ = 0;
  bool started_ = false;
};

}  // namespace sandhopper
