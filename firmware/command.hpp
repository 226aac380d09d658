#pragma once
#include <array>
#include <cstdint>

#include "config/fields.hpp"
#include "drivers/motor_command.hpp"
#include "drivers/samples.hpp"

namespace sandhopper {

struct Command {
  std::array<MotorCommand, kMotorCount> motor{};
  DriveRequest drive = DriveRequest::off;
  bool open_catch = false;  // the magnet that holds the body before a hop

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("motor", self.motor);
    visit("drive", self.drive);
    visit("open_catch", self.open_catch);
  }
};

}  // namespace sandhopper
