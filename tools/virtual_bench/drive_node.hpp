#pragma once
#include <memory>

#include "tools/virtual_bench/bench_world.hpp"
#include "tools/virtual_bench/can_bus.hpp"
#include "tools/virtual_bench/drives/emulated_drive.hpp"
#include "tools/virtual_bench/event_loop.hpp"

namespace sandhopper::bench {

// An emulated drive on the bench's bus, world and clock.
class DriveNode {
 public:
  struct Place {
    EventLoop& loop;
    BenchWorld& world;
    CanBus& bus;
    std::int64_t drive_timeout_ns = 0;  // EmulatedDrive::Wiring::timeout_ns
  };
  DriveNode(const Place& place, Side side, const CubeMarsConfig& config);

  void receive(const can_frame& frame);

 private:
  void wake_for_own();

  Place place_;
  std::unique_ptr<EmulatedDrive> drive_;
  std::int64_t awake_at_ns_ = EmulatedDrive::kNever_ns;  // a timer stands for then
};

}  // namespace sandhopper::bench
