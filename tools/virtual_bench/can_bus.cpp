#include "tools/virtual_bench/can_bus.hpp"

#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>

#include <stdexcept>

namespace sandhopper::bench {

CanBus::CanBus(EventLoop& loop, const std::string& interface)
    : loop_(loop), socket_(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW)) {
  const can_filter data_frames{.can_id = 0, .can_mask = CAN_RTR_FLAG};
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(::if_nametoindex(interface.c_str()));
  if (!socket_ || address.can_ifindex == 0 ||
      ::setsockopt(socket_.get(), SOL_CAN_RAW, CAN_RAW_FILTER, &data_frames, sizeof data_frames) != 0 ||
      ::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    throw std::runtime_error("no CAN interface " + interface +
                             ": the bench has vcan0; set can.interface to it");
  loop_.watch(socket_.get(), [this] { receive(); });
}

CanBus::~CanBus() { loop_.forget(socket_.get()); }

void CanBus::send(const can_frame& frame) {
  // A full queue loses the frame, as a node without retransmission does.
  [[maybe_unused]] const auto sent = ::write(socket_.get(), &frame, sizeof frame);
}

void CanBus::receive() {
  can_frame frame{};
  while (::read(socket_.get(), &frame, sizeof frame) == static_cast<ssize_t>(sizeof frame))
    for (const auto& node : nodes_) node(frame);
}

}  // namespace sandhopper::bench
