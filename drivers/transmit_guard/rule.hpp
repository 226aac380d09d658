#pragma once
#include <array>
#include <cstdint>

#include "config/fields.hpp"

namespace sandhopper {

namespace transmit {

// Reason why the transmit guard refused a frame. The number is logged, so new rules go to the end.
enum class Rule : std::uint8_t {
  none,
  identifier,     // not a command identifier of a configured motor in its dialect
  length,         // not a length of the dialect
  set_zero,       // the drive would not answer for a second
  torque,         // above the limit
  stiffness,      // above the limit
  damping,        // above the limit; servo: a current that does not damp while only damping may pass
  speed,          // velocity set-point above the limit
  angle,          // position set-point with stiffness outside the leg's angles
  stiffness_far,  // stiffness begins so far from the measured angle that its torque would exceed the limit
  not_confirmed,  // torque or gains, but the drive was not seen to be in motor mode
  unanswered,     // torque or stiffness, but the drive has not answered for too long
  enter_loaded,   // enter motor mode, but the last command had torque or gains: the drive would remember it
  restricted,     // not allowed by the latched fault's reaction
  stopped,        // the e-stop is open
  second_frame,   // of one motor in one cycle
  outstanding,    // the previous command may still be answered
  bus_load,       // more bits than the bus may carry
  latched         // a frame was refused before
};

}  // namespace transmit

template <>
struct EnumNames<transmit::Rule> {
  static constexpr std::array<std::string_view, 19> value{
      "none",    "identifier",   "length",        "set_zero",      "torque",     "stiffness",    "damping",
      "speed",   "angle",        "stiffness_far", "not_confirmed", "unanswered", "enter_loaded", "restricted",
      "stopped", "second_frame", "outstanding",   "bus_load",      "latched"};
};

// Number of frames that the transmit guard refused since start, and the first of them. Later refusals follow
// from the first.
struct RefusedFrames {
  std::uint32_t count = 0;
  transmit::Rule rule = transmit::Rule::none;
  std::uint32_t can_id = 0;  // with the flags of linux/can.h
  std::uint8_t length = 0;
  std::array<std::uint8_t, 8> data{};

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("count", self.count);
    visit("rule", self.rule);
    visit("can_id", self.can_id);
    visit("length", self.length);
    visit("data", self.data);
  }
};

}  // namespace sandhopper
