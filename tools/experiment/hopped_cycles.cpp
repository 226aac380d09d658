#include "tools/experiment/hopped_cycles.hpp"

namespace sandhopper {

HoppedCycles::HoppedCycles(const CycleConfig& cycle, const WorldConfig& world, const TrialSetup& setup,
                           std::int64_t hang_cycles)
    : world_(world, setup, 0), board_(world_), controller_(cycle), hang_cycles_(hang_cycles) {}

bool HoppedCycles::next(const std::function<void(SensorFrame&)>& change) {
  ++cycle_;
  frame_.time_ns = cycle_ * kPeriod_ns;
  frame_.cycle = static_cast<std::uint64_t>(cycle_);
  frame_.request = request_;
  request_ = Request::none;
  before_ = truth_;
  board_.read(frame_);
  truth_ = world_.truth();
  reported_ = frame_;
  if (change) change(reported_);
  output_ = &controller_.step(reported_);
  board_.write(output_->command);
  for (const auto& event : controller_.events())
    if (event.kind == EventKind::armed) release_cycle_ = cycle_ + hang_cycles_;
  if (cycle_ == release_cycle_) request_ = Request::release;
  return !faulted() && !(output_->state == State::idle && cycle_ > 1) && cycle_ + 1 < kLongest_cycles;
}

}  // namespace sandhopper
