#pragma once
#include <linux/can.h>

#include <cstdint>
#include <vector>

#include "drivers/can/can_config.hpp"
#include "drivers/can/can_socket.hpp"

namespace sandhopper {

// Frames that take the torque from every drive, each in its own dialect: first a command without gains and
// torque to all, then leave motor mode to all drives whose dialect has it. They do not depend on the drives'
// state.
std::vector<can_frame> torque_cut_frames(const CanConfig& config);

// Takes the torque away from outside the cycle: sends prepared frames over its own socket, which receives
// nothing. Any one thread, or a signal handler, may call cut().
class TorqueCut {
 public:
  // Throws DeviceError when the interface is missing or down.
  explicit TorqueCut(const CanConfig& config);

  // Never waits. Frames the kernel does not take are not kept: call it again.
  void cut() noexcept;

  int descriptor() const noexcept { return socket_.descriptor(); }
  std::uint32_t frames_sent() const noexcept { return socket_.counters().sent; }

 private:
  std::vector<can_frame> frames_;
  CanSocket socket_;
};

}  // namespace sandhopper
