#include "tools/faults/forwarding_port.hpp"

namespace sandhopper::faults {

std::optional<std::int64_t> MiscodingPort::send(const can_frame& frame) noexcept {
  can_frame wrong = frame;
  if (on_ && frame.can_dlc == 8) {
    wrong.data[6] |= 0x0F;
    wrong.data[7] = 0xFF;
  } else if (on_) {
    wrong.data[0] = 0x7F;
  }
  return ForwardingPort::send(wrong);
}

}  // namespace sandhopper::faults
