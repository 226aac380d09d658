#pragma once
#include <array>
#include <cstdint>

#include "config/fields.hpp"
#include "drivers/samples.hpp"
#include "firmware/fault.hpp"

namespace sandhopper {

// State of the motors and latched fault with which the cycle starts. It is an input of the cycle: it is
// stored in the trial's log (start.toml), and a replay starts with it.
struct StartState {
  bool temperatures_known = false;  // false: every motor is at supervision.ambient_C
  std::array<double, kMotorCount> winding_C{};
  std::array<double, kMotorCount> housing_C{};
  std::uint32_t touchdowns = 0;  // since the leg was inspected
  Fault fault = Fault::none;     // still latched; `disarm` ends it

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("temperatures_known", self.temperatures_known);
    visit("winding_C", self.winding_C, Range{-100.0, 1000.0});
    visit("housing_C", self.housing_C, Range{-100.0, 1000.0});
    visit("touchdowns", self.touchdowns);
    visit("fault", self.fault);
  }
};

// Sample of the robot's state that the cycle passes to StateKeeper each turn.
struct StateSample {
  std::array<double, kMotorCount> winding_C{};
  std::array<double, kMotorCount> housing_C{};
  std::array<double, kMotorCount> position_rad{};  // link angle, unwrapped; NaN before the first reply
  std::uint32_t touchdowns = 0;                    // since the leg was inspected
  Fault fault = Fault::none;                       // not yet disarmed
};

}  // namespace sandhopper
