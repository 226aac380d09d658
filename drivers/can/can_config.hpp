#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "config/fields.hpp"
#include "drivers/can/mit_protocol.hpp"
#include "drivers/samples.hpp"

namespace sandhopper {

// Dialect of a CubeMars drive: one of three incompatible protocols. Sending the wrong one can damage the
// board. So it is configured per motor, and a drive whose frames do not match it is not energised.
//   mit: board V1/V2 in MIT mode, standard identifiers
//   servo: board V1/V2 in servo mode, extended identifiers, unasked status frames; torque by current
//   v3: board V3, MIT as mode 8 of extended identifiers, every command answered by a status frame
enum class Dialect : std::uint8_t { mit, servo, v3 };
template <>
struct EnumNames<Dialect> {
  static constexpr std::array<std::string_view, 3> value{"mit", "servo", "v3"};
};

// One motor with its drive. Link angle = zero_offset_rad + sign * drive position / gear_ratio.
struct CubeMarsConfig {
  std::string name;   // in messages
  int can_id = 1;     // standard identifier of commands, byte 0 of replies
  int master_id = 0;  // identifier of replies; 0 (default of many drives) and can_id are accepted too
  Dialect dialect = Dialect::mit;
  ReplyFlavour reply = ReplyFlavour::temperature_offset_40;
  double position_range_rad = 12.5;
  double velocity_range_radps = 50.0;
  double kp_range_Nm_per_rad = 500.0;
  double kd_range_Nm_s_per_rad = 5.0;
  double torque_range_Nm = 18.0;
  int sign = 1;             // +1 or -1: drive positive shortens the leg, or lengthens it
  double gear_ratio = 1.0;  // between the drive's output and the link; the drive's own gearbox is not counted
  double zero_offset_rad = 0.0;  // link angle at the drive's zero
  // Torque at the output per q-axis ampere: the calibrated value, and the value with which the drive's
  // firmware converts its torque field into current. Nameplates are off by 13-20 %.
  double torque_constant_Nm_per_A = 0.0868;
  double drive_torque_constant_Nm_per_A = 0.0868;
  // Time from handing a command to the kernel until the drive samples the state of its reply: the command's
  // time on the wire (0.11-0.14 ms at 1 Mbit/s; twice that for the second motor of a bus).
  double state_delay_s = 0.0;
  // Scaling of a status frame (servo, v3): its speed counts electrical turns of the motor, its position those
  // of the output.
  int pole_pairs = 21;
  double drive_reduction = 1.0;   // gearbox inside the drive: motor turns per turn of its output
  double status_rate_Hz = 500.0;  // servo: as set in the drive (1 to 500)

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("name", self.name);
    visit("can_id", self.can_id, Range{1, 0x7E});
    visit("master_id", self.master_id, Range{0, 0x7FF});
    visit("dialect", self.dialect);
    visit("reply", self.reply);
    visit("position_range_rad", self.position_range_rad, Range{0.1, 1000.0});
    visit("velocity_range_radps", self.velocity_range_radps, Range{0.1, 1000.0});
    visit("kp_range_Nm_per_rad", self.kp_range_Nm_per_rad, Range{0.1, 10000.0});
    visit("kd_range_Nm_s_per_rad", self.kd_range_Nm_s_per_rad, Range{0.01, 1000.0});
    visit("torque_range_Nm", self.torque_range_Nm, Range{0.01, 1000.0});
    visit("sign", self.sign, Range{-1, 1});
    visit("gear_ratio", self.gear_ratio, Range{0.01, 200.0});
    visit("zero_offset_rad", self.zero_offset_rad, Range{-100.0, 100.0});
    visit("torque_constant_Nm_per_A", self.torque_constant_Nm_per_A, Range{1e-3, 100.0});
    visit("drive_torque_constant_Nm_per_A", self.drive_torque_constant_Nm_per_A, Range{1e-3, 100.0});
    visit("state_delay_s", self.state_delay_s, Range{0.0, 0.001});
    visit("pole_pairs", self.pole_pairs, Range{1, 100});
    visit("drive_reduction", self.drive_reduction, Range{0.01, 200.0});
    visit("status_rate_Hz", self.status_rate_Hz, Range{1.0, 500.0});
  }

  // Rules the ranges above do not express: problem(key, error and remedy).
  template <class Problem>
  void check(Problem&& problem) const {
    if (dialect == Dialect::servo && status_rate_Hz < 400.0)
      problem("status_rate_Hz",
              "a servo-mode drive that sends fewer than 400 status frames a second cannot be supervised in a "
              "1 ms cycle: "
              "set its upload rate to 500 Hz with CubeMars' serial tool and status_rate_Hz = 500");
    if (sign == 0) problem("sign", "must be 1 or -1");
  }
};

// Replies per second that this drive must send in a 1 kHz cycle.
constexpr double replies_per_s(const CubeMarsConfig& motor) noexcept {
  return motor.dialect == Dialect::servo ? motor.status_rate_Hz : 1000.0;
}

// Constants of the protocols (AK Series Module Driver User Manual V1.0.18). The robot's limits are checked
// against them, too.
inline constexpr double kServoCurrentRange_A = 60.0;  // largest current command, servo dialect
inline constexpr double kBusVoltageRange_V = 40.0;    // full scale of reply = "bus_voltage"
// Share of the position range above which a reply counts as near the range's end: 11 rad of 12.5 rad.
inline constexpr double kUsablePositionShare = 0.88;

// True if the drive computes the torque of position and velocity gains itself, from its own measurement.
// Otherwise the host computes it from the newest sample.
constexpr bool law_in_drive(const CubeMarsConfig& motor) noexcept { return motor.dialect != Dialect::servo; }

using MotorConfigs = std::array<CubeMarsConfig, kMotorCount>;

// Checks that concern both motors of one bus.
template <class Problem>
void check_motors(const MotorConfigs& motor, Problem&& problem) {
  if (motor[0].can_id == motor[1].can_id)
    problem("motor[1].can_id",
            "both motors have the same can_id: give each drive its own, one drive connected at a time");
  for (std::size_t i = 0; i < kMotorCount; ++i)
    if (motor[i].master_id == motor[1 - i].can_id)
      problem(i == 0 ? "motor[0].master_id" : "motor[1].master_id",
              "one motor's master_id is the other's can_id: replies would collide with commands");
}

// Worst-case share of a 1 Mbit/s bus at 1 kHz. Every frame counts with all its stuff bits and the
// intermission: 55 + 10 n bits with a standard identifier and n bytes, 80 + 10 n with an extended one (ISO
// 11898-1).
struct CanConfig;
double bus_load(const CanConfig& config) noexcept;
int in_percent(double share) noexcept;
inline constexpr double kMostBusLoad = 0.8;  // the rest is for repeated frames
template <class Problem>
void check_bus_load(const CanConfig& config, Problem&& problem);

struct CanConfig {
  std::string interface = "can0";
  // Period [cycles] of leave frames while the drives are off. The other cycles send a command without gains
  // and torque, which asks for the state and energises nothing.
  int idle_query_cycles = 10;
  // Share of the bus that other nodes use, 0 to 1.
  double other_load = 0.0;
  // These are not keys of this table: the motors are in the robot's file and are the same on every bus
  // (config/files.hpp). If a single motor drives both sides only the first is used.
  int motor_count = kMotorCount;
  // Torque limit of one motor, from the robot's limits. It bounds the torque that the host computes
  // (host_law.hpp).
  double motor_torque_Nm = 1e9;
  MotorConfigs motor{CubeMarsConfig{.name = "left", .can_id = 1, .master_id = 0x11},
                     CubeMarsConfig{.name = "right", .can_id = 2, .master_id = 0x12}};

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("interface", self.interface);
    visit("idle_query_cycles", self.idle_query_cycles, Range{1, 1000});
    visit("other_load", self.other_load, Range{0.0, 1.0});
  }

  template <class Problem>
  void check(Problem&& problem) const {
    check_motors(motor, problem);
    check_bus_load(*this, problem);
  }
};

template <class Problem>
void check_bus_load(const CanConfig& config, Problem&& problem) {
  const double load = bus_load(config);
  if (load > kMostBusLoad)
    problem("other_load", "the bus would be loaded to " + std::to_string(in_percent(load)) +
                              " %, more than 80 %: put other nodes, or one motor, on a bus of their own");
}

}  // namespace sandhopper
