#include "drivers/can/can_port.hpp"

#include <linux/can/error.h>

namespace sandhopper {

void count_error_frame(const can_frame& frame, CanCounters& counters) noexcept {
  ++counters.error_frames;
  const auto has = [&](canid_t error_class) { return (frame.can_id & error_class) != 0; };
  const std::uint8_t controller = has(CAN_ERR_CRTL) ? frame.data[1] : 0;
  const auto says = [&](int bits) { return (controller & bits) != 0; };
  if (has(CAN_ERR_ACK)) ++counters.no_acknowledge;
  if (has(CAN_ERR_PROT) || has(CAN_ERR_TRX) || has(CAN_ERR_TX_TIMEOUT) || says(CAN_ERR_CRTL_TX_OVERFLOW))
    ++counters.errors;
  if (says(CAN_ERR_CRTL_RX_OVERFLOW)) ++counters.receive_overflows;
  if (counters.state == BusState::off) return;
  if (says(CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE))
    counters.state = BusState::passive;
  else if (says(CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING))
    counters.state = BusState::warning;
  else if (says(CAN_ERR_CRTL_ACTIVE))
    counters.state = BusState::active;
  if (has(CAN_ERR_BUSOFF)) counters.state = BusState::off;
}

}  // namespace sandhopper
