#pragma once
#include <array>
#include <cstdint>
#include <string_view>

#include "config/fields.hpp"

namespace sandhopper {

enum class Fault : std::uint8_t {
  none,
  emergency_stop,
  motor_reply_lost,
  drive_error,
  encoders_disagree,
  leg_angle_limit,
  motor_speed_limit,
  imu_stale,
  tof_stale,
  load_cell_stale,
  estimate_not_finite,
  bus_fault,
  motor_temperature,
  phase_timeout
};
inline constexpr std::size_t kFaultCount = 14;

template <>
struct EnumNames<Fault> {
  static constexpr std::array<std::string_view, kFaultCount> value{"none",
                                                                   "emergency_stop",
                                                                   "motor_reply_lost",
                                                                   "drive_error",
                                                                   "encoders_disagree",
                                                                   "leg_angle_limit",
                                                                   "motor_speed_limit",
                                                                   "imu_stale",
                                                                   "tof_stale",
                                                                   "load_cell_stale",
                                                                   "estimate_not_finite",
                                                                   "bus_fault",
                                                                   "motor_temperature",
                                                                   "phase_timeout"};
};

// What the robot does about a fault. damp: viscous leg until still, then limp. limp: zero torque at once.
enum class Reaction : std::uint8_t { none, damp, limp };
template <>
struct EnumNames<Reaction> {
  static constexpr std::array<std::string_view, 3> value{"none", "damp", "limp"};
};

struct FaultEntry {
  Fault fault;
  Reaction reaction;
  std::string_view meaning;
  std::string_view cure;
};

// Indexed by the fault's number; the number is what `hop explain` and the log show.
inline constexpr std::array<FaultEntry, kFaultCount> kFaults{{
    {Fault::none, Reaction::none, "no fault", ""},
    {Fault::emergency_stop, Reaction::limp, "the e-stop line reads open: button pressed or wire cut",
     "release the button, check the e-stop wiring, then arm again"},
    {Fault::motor_reply_lost, Reaction::damp, "a drive did not answer for limits.motor_reply_misses cycles",
     "check CAN wiring, termination, drive supply and can_id; see `hop doctor`"},
    {Fault::drive_error, Reaction::limp, "a drive reports an error code",
     "read the code in the log (/frame motor.error_code): 1 motor hot, 2 over-current, 3 over-voltage, 4 "
     "under-voltage, "
     "5 encoder, 6 driver hot, 7 stall; remove the cause and power-cycle the drive"},
    {Fault::encoders_disagree, Reaction::damp,
     "left and right upper links differ by more than limits.encoder_mismatch_rad",
     "check the coupling of both hips and repeat the zeroing of both encoders"},
    {Fault::leg_angle_limit, Reaction::damp, "the upper link left the allowed angles",
     "check the zero of the encoders and the limits leg_angle_min_rad, leg_angle_max_rad"},
    {Fault::motor_speed_limit, Reaction::damp, "a motor turns faster than limits.motor_speed_radps",
     "check for a broken link or slipping coupling; lower the release height"},
    {Fault::imu_stale, Reaction::damp, "an IMU has delivered nothing for limits.imu_age_s",
     "check its cable and data-ready line"},
    {Fault::tof_stale, Reaction::damp,
     "the time-of-flight sensor has delivered nothing valid for limits.tof_age_s",
     "check that the companion controller streams and that the beam sees the sand"},
    {Fault::load_cell_stale, Reaction::damp,
     "the load cell's converter has delivered nothing for limits.load_cell_age_s",
     "check the I2C cable and the ALERT/RDY line"},
    {Fault::estimate_not_finite, Reaction::limp, "an estimate is not a number",
     "send the log: a sensor delivered what its checks should have caught"},
    {Fault::bus_fault, Reaction::damp, "the CAN bus refused or lost frames",
     "check bus load, wiring and termination; restart the interface after bus-off"},
    {Fault::motor_temperature, Reaction::damp, "a motor is hotter than limits.motor_temperature_C",
     "let it cool; lower the torque limit or the hop rate"},
    {Fault::phase_timeout, Reaction::damp, "flight or stance lasted longer than limits.phase_time_s",
     "check that the robot was released over the bed, that the ToF sensor sees it and that the leg can reach "
     "its extension length"},
}};

constexpr bool faults_are_in_order() {
  for (std::size_t i = 0; i < kFaultCount; ++i)
    if (static_cast<std::size_t>(kFaults[i].fault) != i) return false;
  return true;
}
static_assert(faults_are_in_order());

constexpr const FaultEntry& entry_of(Fault fault) { return kFaults[static_cast<std::size_t>(fault)]; }

}  // namespace sandhopper
