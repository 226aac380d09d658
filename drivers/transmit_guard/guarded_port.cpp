#include "drivers/transmit_guard/guarded_port.hpp"

#include <algorithm>
#include <utility>

namespace sandhopper {

GuardedPort::GuardedPort(std::unique_ptr<CanPort> port, const transmit::Limits& limits) noexcept
    : port_(std::move(port)), guard_(limits) {}

void GuardedPort::begin_cycle() noexcept {
  guard_.begin_frames();
  port_->begin_cycle();
}

std::optional<std::int64_t> GuardedPort::send(const can_frame& frame) noexcept {
  const auto verdict = guard_.judge(frame);
  if (verdict.rule != transmit::Rule::none) {
    refuse(frame, verdict);
    return std::nullopt;
  }
  const auto time_ns = port_->send(frame);
  if (time_ns) guard_.sent(verdict, *time_ns);
  return time_ns;
}

void GuardedPort::refuse(const can_frame& frame, const transmit::TransmitGuard::Verdict& verdict) noexcept {
  if (refused_.count++ == 0) {
    refused_.rule = verdict.rule;
    refused_.can_id = frame.can_id;
    refused_.length = frame.can_dlc;
    std::copy_n(frame.data, refused_.data.size(), refused_.data.begin());
  }
  if (tap_ != nullptr) tap_->on_refused(frame, guard_.now_ns());
  guard_.refused();
  using transmit::Meaning;
  const auto meaning = verdict.decoded.meaning;
  if (!verdict.known || meaning == Meaning::enter || meaning == Meaning::set_zero) return;
  const can_frame& zero = guard_.zero_frame(verdict.motor);
  auto instead = guard_.judge(zero);
  if (instead.rule != transmit::Rule::none) return;
  if (const auto time_ns = port_->send(zero)) guard_.sent(instead, *time_ns);
}

std::span<const ReceivedFrame> GuardedPort::receive(bool& more) noexcept {
  const auto frames = port_->receive(more);
  for (const auto& received : frames) guard_.received(received.frame);
  return frames;
}

void GuardedPort::pause(std::int64_t duration_ns) noexcept {
  port_->pause(duration_ns);
  guard_.advance(duration_ns);
}

void GuardedPort::set_tap(CanTap* tap) noexcept {
  tap_ = tap;
  port_->set_tap(tap);
}

}  // namespace sandhopper
