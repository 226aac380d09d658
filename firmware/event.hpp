#pragma once
#include <array>
#include <cstdint>

#include "config/fields.hpp"
#include "firmware/fault.hpp"

namespace sandhopper {

enum class EventKind : std::uint8_t {
  armed,
  zero_check,
  released,
  touchdown,
  stance_switch,
  liftoff,
  stop_requested,
  stopped,
  fault_raised,
  disarmed,
  arming_refused,
  disarm_refused,
  clock_stepped
};
template <>
struct EnumNames<EventKind> {
  static constexpr std::array<std::string_view, 13> value{
      "armed",          "zero_check",     "released",     "touchdown",    "stance_switch",
      "liftoff",        "stop_requested", "stopped",      "fault_raised", "disarmed",
      "arming_refused", "disarm_refused", "clock_stepped"};
};

// Condition that caused an event.
enum class Reason : std::uint8_t {
  operator_request,
  free_fall,
  leg_deflection,
  leg_rate,
  leg_extended,
  leg_rate_reversed,
  strides_done,
  settled,
  encoders_disagree,
  not_at_zero_pose,
  moving,
  sensor_missing,
  fault,
  zero_confirmed,
  catch_opened,
  date_changed,
  drives_not_confirmed
};
template <>
struct EnumNames<Reason> {
  static constexpr std::array<std::string_view, 17> value{"operator_request",
                                                          "free_fall",
                                                          "leg_deflection",
                                                          "leg_rate",
                                                          "leg_extended",
                                                          "leg_rate_reversed",
                                                          "strides_done",
                                                          "settled",
                                                          "encoders_disagree",
                                                          "not_at_zero_pose",
                                                          "moving",
                                                          "sensor_missing",
                                                          "fault",
                                                          "zero_confirmed",
                                                          "catch_opened",
                                                          "date_changed",
                                                          "drives_not_confirmed"};
};

// An event with the values that triggered it. Meaning of the values by kind:
//   zero_check, arming_refused: left angle, right angle, expected angle [rad], largest range [rad]
//   arming_refused for drives_not_confirmed: measured torque left, right (NaN: no such motor), commanded
//     torque [N m], tries; torque_follows() (drive_confirmation.hpp) finds the motor that failed
//   released: body specific force [m/s^2], foot height [m], body height [m], 0
//   touchdown, stance_switch, liftoff: leg length [m], leg rate [m/s], foot height [m], foot velocity [m/s]
//   fault_raised, disarm_refused: the two values that the fault's check names (fault_checks.hpp), 0, 0
//   clock_stepped: jump of CLOCK_REALTIME [s], 0, 0, 0
struct Event {
  std::int64_t time_ns = 0;
  EventKind kind = EventKind::armed;
  Reason reason = Reason::operator_request;
  Fault fault = Fault::none;
  std::uint32_t stride = 0;
  std::array<double, 4> values{};

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("time_ns", self.time_ns);
    visit("kind", self.kind);
    visit("reason", self.reason);
    visit("fault", self.fault);
    visit("stride", self.stride);
    visit("values", self.values);
  }
};

}  // namespace sandhopper
