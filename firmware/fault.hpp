#pragma once
#include <array>
#include <cstdint>
#include <string_view>

#include "config/fields.hpp"

// Table of all faults: number, name, reaction, latch, detection delay, meaning and cure. `hop explain`, the
// log, the report and the fault matrix (tools/faults) all read this table.
// table.
namespace sandhopper {

// `hop explain` and the log show the number, so new faults go to the end.
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
  phase_timeout,
  bus_off,
  bus_passive,
  bus_send_refused,
  bus_overflow,
  motor_reply_intermittent,
  motor_reply_late,
  motor_reply_unexpected,
  motor_reply_foreign,
  motor_position_jump,
  motor_velocity_implausible,
  motor_torque_implausible,
  encoder_stuck,
  motor_current_limit,
  motor_torque_limit,
  motor_winding_hot,
  bus_voltage_limit,
  imu_stuck,
  imu_out_of_range,
  imu_implausible,
  tilt_limit,
  tof_stuck,
  tof_out_of_range,
  tof_implausible,
  load_cell_stuck,
  load_cell_out_of_range,
  load_cell_implausible,
  sensor_intermittent,
  sample_time_invalid,
  leg_length_limit,
  body_speed_limit,
  body_height_limit,
  energy_implausible,
  hop_count_limit,
  cycle_gap,
  cycle_overruns,
  watchdog_tripped,
  estimate_diverged,
  transmit_refused,
};

inline constexpr std::size_t kFaultCount = 52;

// Reaction of the robot to a fault, gentlest first. A harsher reaction replaces a gentler one.
//   stop: the next touchdown, or the present stance, becomes a soft stop
//   hold: the drives' own law keeps the leg at its position, then damp
//   damp: the drives' own law damps the leg until fault_damp_s is over, then limp
//   limp: zero torque at once, drives off
enum class Reaction : std::uint8_t { none, stop, hold, damp, limp };
template <>
struct EnumNames<Reaction> {
  static constexpr std::array<std::string_view, 5> value{"none", "stop", "hold", "damp", "limp"};
};

// Condition that ends a fault. The robot cannot be armed before.
//   until_disarmed: the operator's `disarm`
//   until_released: `disarm`, which is refused while the e-stop line still reads open
//   until_restart: `disarm` is refused; hopperd must be started again
enum class Latch : std::uint8_t { none, until_disarmed, until_released, until_restart };
template <>
struct EnumNames<Latch> {
  static constexpr std::array<std::string_view, 4> value{"none", "until_disarmed", "until_released",
                                                         "until_restart"};
};

struct FaultEntry {
  Fault fault;
  std::string_view name;
  Reaction reaction;
  Latch latch;
  int cycles;  // largest delay [cycles] from the first cycle that could show the fault to the reaction, with
               // the limits of config/robot.toml
  std::string_view meaning;
  std::string_view cure;
};

// Indexed by the fault's number.
inline constexpr std::array<FaultEntry, kFaultCount> kFaults{{
    {Fault::none, "none", Reaction::none, Latch::none, 0, "no fault", ""},
    {Fault::emergency_stop, "emergency_stop", Reaction::limp, Latch::until_released, 1,
     "the e-stop line reads open, or was open for a moment: button pressed or wire cut",
     "release the button, check the e-stop wiring, disarm, then arm again"},
    {Fault::motor_reply_lost, "motor_reply_lost", Reaction::damp, Latch::until_disarmed, 3,
     "a drive did not answer for limits.motor_reply_misses cycles",
     "check CAN wiring, termination, drive supply and can_id; see `hop doctor`"},
    {Fault::drive_error, "drive_error", Reaction::limp, Latch::until_disarmed, 2,
     "a drive reports an error code",
     "read the code in the log (/frame motor.error_code): 1 motor hot, 2 over-current, 3 over-voltage, 4 "
     "under-voltage, 5 encoder, 6 driver hot, 7 stall, 100 position near the end of its range; remove the "
     "cause and power-cycle the drive"},
    {Fault::encoders_disagree, "encoders_disagree", Reaction::damp, Latch::until_disarmed, 20,
     "left and right upper links differ by more than limits.encoder_mismatch_rad",
     "check the coupling of both hips and repeat the zeroing of both encoders"},
    {Fault::leg_angle_limit, "leg_angle_limit", Reaction::damp, Latch::until_disarmed, 2,
     "the upper link left the allowed angles",
     "check the zero of the encoders and the limits leg_angle_min_rad, leg_angle_max_rad"},
    {Fault::motor_speed_limit, "motor_speed_limit", Reaction::damp, Latch::until_disarmed, 2,
     "a motor turns faster than limits.motor_speed_radps",
     "check for a broken link or slipping coupling; lower the release height"},
    {Fault::imu_stale, "imu_stale", Reaction::damp, Latch::until_disarmed, 12,
     "an IMU's newest sample is older than limits.imu_age_s", "check its cable and data-ready line"},
    {Fault::tof_stale, "tof_stale", Reaction::damp, Latch::until_disarmed, 102,
     "the time-of-flight sensor's newest sample is older than limits.tof_age_s",
     "check that the companion controller streams and that the beam sees the sand"},
    {Fault::load_cell_stale, "load_cell_stale", Reaction::damp, Latch::until_disarmed, 52,
     "the load cell's newest sample is older than limits.load_cell_age_s",
     "check the I2C cable and the ALERT/RDY line"},
    {Fault::estimate_not_finite, "estimate_not_finite", Reaction::limp, Latch::until_disarmed, 2,
     "an estimate is not a number", "send the log: a sensor delivered what its checks should have caught"},
    {Fault::bus_fault, "bus_fault", Reaction::damp, Latch::until_disarmed, 2,
     "the CAN controller reports protocol or transceiver errors",
     "check wiring, termination (two times 120 ohm) and that every node runs at 1 Mbit/s"},
    {Fault::motor_temperature, "motor_temperature", Reaction::damp, Latch::until_disarmed, 2,
     "a drive reports more than limits.motor_temperature_C",
     "let it cool; lower the torque limit or the hop rate; if it is cold, check the motor's `reply` key: "
     "some drives send the temperature without the offset of 40"},
    {Fault::phase_timeout, "phase_timeout", Reaction::damp, Latch::until_disarmed, 2,
     "flight, stance or the soft stop lasted longer than limits.phase_time_s",
     "a robot that comes to rest in stance is stopped softly instead, so it hangs, or moves on without a "
     "touchdown or liftoff: check that it was released over the bed and that the ToF sensor sees it"},
    {Fault::bus_off, "bus_off", Reaction::limp, Latch::until_restart, 1,
     "the CAN controller has switched itself off the bus",
     "remove the short or the node at the wrong bit rate, then `ip link set can0 down`, up, and restart "
     "hopperd: the interface is not restarted by itself"},
    {Fault::bus_passive, "bus_passive", Reaction::damp, Latch::until_disarmed, 1,
     "the CAN controller is error-passive or nobody acknowledges its frames",
     "check that the cable is plugged in and the drives have power; a node alone on a bus gets no "
     "acknowledge"},
    {Fault::bus_send_refused, "bus_send_refused", Reaction::limp, Latch::until_disarmed, 2,
     "the kernel did not take a command, or one of the cycle before had not left yet",
     "check the bus: frames do not leave (no acknowledge, other traffic, interface down); nothing was sent a "
     "second time"},
    {Fault::bus_overflow, "bus_overflow", Reaction::damp, Latch::until_disarmed, 2,
     "received CAN frames were dropped, by the controller or because nobody read them",
     "look for a babbling node with candump; check the cycle's overruns and, on mcp251xfd, the coalescing "
     "(ethtool -c)"},
    {Fault::motor_reply_intermittent, "motor_reply_intermittent", Reaction::damp, Latch::until_disarmed, 60,
     "a drive answers less than supervision.motor_reply_share of its commands",
     "check connectors and shield of the CAN cable and the drive's master_id: replies that lose arbitration "
     "are not repeated"},
    {Fault::motor_reply_late, "motor_reply_late", Reaction::damp, Latch::until_disarmed, 10,
     "a drive's answers come later than supervision.motor_reply_age_s after their commands",
     "check what else is on the bus and whether a gateway or USB adapter delays frames"},
    {Fault::motor_reply_unexpected, "motor_reply_unexpected", Reaction::damp, Latch::until_disarmed, 10,
     "a drive answers more often than it is asked",
     "check that no two drives have one id and that no other program commands the drives"},
    {Fault::motor_reply_foreign, "motor_reply_foreign", Reaction::limp, Latch::until_restart, 2,
     "frames with a drive's identifier do not look like its configured dialect",
     "check motor.dialect against the drive's board and mode (CubeMars' serial tool), power-cycle the drive "
     "and restart hopperd, which then asks each drive again for its dialect; until then none gets torque"},
    {Fault::motor_position_jump, "motor_position_jump", Reaction::damp, Latch::until_disarmed, 2,
     "a position changed faster than the motor can turn, or is not a number",
     "check the encoder, its magnet and the shield of the CAN cable; home again: a single encoder may have "
     "lost its zero"},
    {Fault::motor_velocity_implausible, "motor_velocity_implausible", Reaction::damp, Latch::until_disarmed,
     60, "a drive's velocity does not agree with how its position changes",
     "check motor.velocity_range_radps: some firmware has half the range that its manual states"},
    {Fault::motor_torque_implausible, "motor_torque_implausible", Reaction::damp, Latch::until_disarmed, 25,
     "a drive's current does not follow the commanded torque",
     "check the motor's phases, the drive's current limit (it rescales the torque field) and both torque "
     "constants"},
    {Fault::encoder_stuck, "encoder_stuck", Reaction::damp, Latch::until_disarmed, 60,
     "one side's position stands still while the other side's moves",
     "check the encoder and the coupling of the hip; a stuck encoder cannot be seen while the leg is at "
     "rest"},
    {Fault::motor_current_limit, "motor_current_limit", Reaction::damp, Latch::until_disarmed, 4,
     "a drive reports more current than supervision.motor_current_A",
     "check for a jammed leg and for a shorted phase; lower limits.motor_torque_Nm"},
    {Fault::motor_torque_limit, "motor_torque_limit", Reaction::damp, Latch::until_disarmed, 320,
     "the commanded torque stood at limits.motor_torque_Nm for longer than supervision.torque_limit_s",
     "check for a jammed leg; lower the release height or the stiffness of the virtual spring"},
    {Fault::motor_winding_hot, "motor_winding_hot", Reaction::stop, Latch::until_disarmed, 20,
     "the thermal model puts a winding over supervision.winding_temperature_C",
     "let the motors cool; hop more slowly or lower the torque; check [supervision] winding and housing "
     "constants"},
    {Fault::bus_voltage_limit, "bus_voltage_limit", Reaction::limp, Latch::until_disarmed, 4,
     "a drive reports a supply outside supervision.bus_voltage_min_V to _max_V",
     "check battery or supply; landing feeds power back: fit a brake resistor or a battery that takes it"},
    {Fault::imu_stuck, "imu_stuck", Reaction::damp, Latch::until_disarmed, 30,
     "an IMU repeats the same sample although its noise was seen before",
     "power-cycle the IMU and check its SPI wiring"},
    {Fault::imu_out_of_range, "imu_out_of_range", Reaction::damp, Latch::until_disarmed, 12,
     "an IMU reads the end of its range, or no number, for supervision.range_samples samples",
     "check the SPI wiring; raise accel_range_g if it was a real impact"},
    {Fault::imu_implausible, "imu_implausible", Reaction::damp, Latch::until_disarmed, 60,
     "the two IMUs do not agree with the leg's encoders, or an IMU's rates are impossible on a rail",
     "check the mounting matrices and ranges of both IMUs, and the SPI wiring"},
    {Fault::tilt_limit, "tilt_limit", Reaction::stop, Latch::until_disarmed, 200,
     "the body leans by more than supervision.tilt_rad", "check the rail's carriage and the IMU's mount"},
    {Fault::tof_stuck, "tof_stuck", Reaction::damp, Latch::until_disarmed, 60,
     "the time-of-flight sensor repeats the same range although its noise was seen before",
     "restart the companion controller and check its supply"},
    {Fault::tof_out_of_range, "tof_out_of_range", Reaction::damp, Latch::until_disarmed, 60,
     "the time-of-flight sensor delivers no measurement for supervision.range_samples samples",
     "check that the beam reaches the sand; the AFBR-S50's API manual lists the status codes"},
    {Fault::tof_implausible, "tof_implausible", Reaction::damp, Latch::until_disarmed, 40,
     "the time-of-flight height jumps by more than a body can move",
     "look for something in the beam; check mount and dual_frequency_mode"},
    {Fault::load_cell_stuck, "load_cell_stuck", Reaction::damp, Latch::until_disarmed, 60,
     "the load cell repeats the same value although its noise was seen before",
     "check the amplifier's supply and the ADC's input"},
    {Fault::load_cell_out_of_range, "load_cell_out_of_range", Reaction::damp, Latch::until_disarmed, 80,
     "the load cell reads beyond supervision.load_cell_range_N while the body's IMU feels no blow, or no "
     "number",
     "check the bridge's wires and the amplifier; an open wire drives it to the end of its range"},
    {Fault::load_cell_implausible, "load_cell_implausible", Reaction::damp, Latch::until_disarmed, 60,
     "the load cell and the momentum observer do not agree",
     "check the load cell's scale, sign and tare, and the torque constants"},
    {Fault::sensor_intermittent, "sensor_intermittent", Reaction::damp, Latch::until_disarmed, 210,
     "a sensor delivers fewer samples than its rate in [supervision]",
     "check its cable; value 1 of the log entry: 0 body IMU, 1 foot IMU, 2 ToF, 3 load cell"},
    {Fault::sample_time_invalid, "sample_time_invalid", Reaction::damp, Latch::until_disarmed, 3,
     "a sample is from the future or older than the one before it",
     "check the device's clock setting and latency_s"},
    {Fault::leg_length_limit, "leg_length_limit", Reaction::damp, Latch::until_disarmed, 2,
     "the leg is shorter or longer than supervision.leg_length_min_m to _max_m",
     "check the end stops, the encoders' zero and the virtual spring's lengths"},
    {Fault::body_speed_limit, "body_speed_limit", Reaction::damp, Latch::until_disarmed, 2,
     "the body is faster than supervision.body_speed_mps",
     "lower the release height; check the ToF sensor and both IMUs"},
    {Fault::body_height_limit, "body_height_limit", Reaction::hold, Latch::until_disarmed, 2,
     "the foot is higher over the sand than supervision.foot_height_m",
     "lower the release height, or raise the limit if the bed and the leg are made for it"},
    {Fault::energy_implausible, "energy_implausible", Reaction::damp, Latch::until_disarmed, 100,
     "in flight the robot gains energy that nobody puts in",
     "check the ToF sensor, both IMUs and the rail: an estimate has gone wrong or something lifts the robot"},
    {Fault::hop_count_limit, "hop_count_limit", Reaction::stop, Latch::until_disarmed, 2,
     "more touchdowns since the leg was inspected than supervision.hop_count",
     "inspect the leg as its schedule says, then start hopperd once with --leg-inspected"},
    {Fault::cycle_gap, "cycle_gap", Reaction::damp, Latch::until_disarmed, 1,
     "the cycle missed supervision.cycle_gap grid points in a row; torque was held meanwhile",
     "look for what stopped the computer: `hop doctor`, other SCHED_FIFO programs, thermal throttling"},
    {Fault::cycle_overruns, "cycle_overruns", Reaction::stop, Latch::until_disarmed, 2,
     "more than supervision.overruns_per_s overruns within a second",
     "give the cycle its own CPU and priority; see firmware/README.md and `hop doctor`"},
    {Fault::watchdog_tripped, "watchdog_tripped", Reaction::limp, Latch::until_disarmed, 1,
     "the watchdog took the torque away because the cycle stood still",
     "find out what stopped the cycle: the log entry has for how many seconds; see the kernel's "
     "messages, "
     "`hop doctor`, and watchdog.cycle_stall_s"},
    {Fault::estimate_diverged, "estimate_diverged", Reaction::damp, Latch::until_disarmed, 100,
     "the estimated height and the time-of-flight sensor have parted: the filter's gate refused twenty "
     "readings in a row",
     "compare tof.height_m (/frame) with estimate.body_z_m (/output) in the log to see which went wrong: an "
     "impact beyond accel_range_g of the IMUs (softer ground, lower release), an IMU whose zero moved since "
     "arming, or something in the ToF sensor's beam"},
    {Fault::transmit_refused, "transmit_refused", Reaction::limp, Latch::until_restart, 2,
     "the transmit guard did not let a frame out to the drives: it broke a rule, so the controller or the "
     "motor "
     "driver is wrong",
     "send the log: bus.refused (/frame) has the rule and the frame's bytes, the CAN log has it as a "
     "comment; "
     "check limits.* and motor.* if they were changed last"},
}};

template <>
struct EnumNames<Fault> {
  static constexpr std::array<std::string_view, kFaultCount> value = [] {
    std::array<std::string_view, kFaultCount> names{};
    for (std::size_t i = 0; i < kFaultCount; ++i) names[i] = kFaults[i].name;
    return names;
  }();
};

constexpr bool faults_are_in_order() {
  for (std::size_t i = 0; i < kFaultCount; ++i)
    if (static_cast<std::size_t>(kFaults[i].fault) != i) return false;
  return true;
}
static_assert(faults_are_in_order());

constexpr const FaultEntry& entry_of(Fault fault) { return kFaults[static_cast<std::size_t>(fault)]; }

}  // namespace sandhopper
