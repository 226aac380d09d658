#pragma once
#include <memory>
#include <utility>

#include "drivers/can/can_port.hpp"

namespace sandhopper::faults {

// Forwards all calls to another port. Base of ports that alter or watch frames.
class ForwardingPort : public CanPort {
 public:
  explicit ForwardingPort(std::unique_ptr<CanPort> port) : port_(std::move(port)) {}

  void begin_cycle() noexcept override { port_->begin_cycle(); }
  std::optional<std::int64_t> send(const can_frame& frame) noexcept override { return port_->send(frame); }
  std::span<const ReceivedFrame> receive(bool& more) noexcept override { return port_->receive(more); }
  bool settled() const noexcept override { return port_->settled(); }
  void pause(std::int64_t duration_ns) noexcept override { port_->pause(duration_ns); }
  bool wait(std::int64_t timeout_ns) noexcept override { return port_->wait(timeout_ns); }
  const CanCounters& counters() const noexcept override { return port_->counters(); }
  void set_tap(CanTap* tap) noexcept override { port_->set_tap(tap); }

 private:
  std::unique_ptr<CanPort> port_;
};

// A driver that codes its commands wrongly: if switched on, the torque field is at full scale.
class MiscodingPort final : public ForwardingPort {
 public:
  using ForwardingPort::ForwardingPort;
  void set(bool on) { on_ = on; }
  std::optional<std::int64_t> send(const can_frame& frame) noexcept override;

 private:
  bool on_ = false;
};

}  // namespace sandhopper::faults
