#pragma once
#include "firmware/command.hpp"
#include "firmware/fault.hpp"
#include "firmware/sensor_frame.hpp"

namespace sandhopper {

// The only interface between the cycle and the hardware. The Linux board (robot and virtual bench alike), the
// simulated board and the replay board implement it; the cycle cannot tell them apart.
class Board {
 public:
  virtual ~Board() = default;

  // Fills `frame` with the newest sample of every device. Never waits for a slow bus. If a device has nothing
  // new its previous sample stays, with fresh = false. The caller sets `frame.time_ns`, `.cycle`,
  // `.overruns`, `.watchdog_stall_ns`, `.wall_clock_step_ns` and `.request`.
  virtual void read(SensorFrame& frame) noexcept = 0;

  // Gives the latched fault before each write(). The board's transmit guard checks the frames against it.
  virtual void note_fault(Fault /*latched*/) noexcept {}

  // Sends the cycle's command. A drive's reply to it is in a later read().
  virtual void write(const Command& command) noexcept = 0;
};

}  // namespace sandhopper
