#pragma once
#include <linux/can.h>

#include <functional>
#include <string>
#include <vector>

#include "drivers/unique_fd.hpp"
#include "tools/virtual_bench/event_loop.hpp"

namespace sandhopper::bench {

// The emulated nodes' place on a CAN interface: every data frame goes to every node.
class CanBus {
 public:
  using Receive = std::function<void(const can_frame&)>;

  // Throws std::runtime_error.
  CanBus(EventLoop& loop, const std::string& interface);
  ~CanBus();
  CanBus(const CanBus&) = delete;
  CanBus& operator=(const CanBus&) = delete;

  void connect(Receive node) { nodes_.push_back(std::move(node)); }
  void send(const can_frame& frame);

 private:
  void receive();

  EventLoop& loop_;
  UniqueFd socket_;
  std::vector<Receive> nodes_;
};

}  // namespace sandhopper::bench
