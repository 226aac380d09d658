#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <memory>

#include "tools/plant/world.hpp"
#include "tools/virtual_bench/event_loop.hpp"

namespace sandhopper::bench {

// The plant on the bench's clock. Every emulated device sees and moves the same one. It is stepped lazily: up
// to now whenever a device looks at it, and whenever a device is due to complete a sample.
class BenchWorld {
 public:
  BenchWorld(EventLoop& loop, const WorldConfig& config, const TrialSetup& setup);

  // The world as of now.
  World& now();

  // A new world with the body held again, from the next whole millisecond on. Keeps what the drives were
  // told.
  void reset(const TrialSetup& setup);
  const TrialSetup& setup() const noexcept { return setup_; }
  const WorldConfig& config() const noexcept { return config_; }

  bool released() const noexcept { return world_->truth().released; }

  void command(Side side, const MotorCommand& command, bool enabled);

  // A device that is given each new sample `delay_ns` after it was measured, or as soon as the plant's 0.1 ms
  // grid and the world's own latency allow.
  template <class Sample>
  struct Outlet {
    std::function<void(const Sample&)> complete;
    std::int64_t delay_ns = 0;
    std::int64_t newest_ns = 0;  // stamp of the last one
  };
  Outlet<ImuSample> imu_body;
  Outlet<ImuSample> imu_foot;
  Outlet<TofSample> tof;
  Outlet<LoadCellSample> load_cell;

  // Called after a reset.
  std::function<void()> on_reset;

 private:
  struct Told {
    MotorCommand command;
    bool enabled = false;
  };
  void advance();
  void publish();
  template <class Sample>
  void publish_new(const Sample& sample, Outlet<Sample>& outlet);
  std::int64_t next_completion_ns() const noexcept;
  void wake_at_next_completion();

  EventLoop& loop_;
  WorldConfig config_;
  TrialSetup setup_;
  std::unique_ptr<World> world_;
  std::array<Told, kMotorCount> commands_{};
  std::int64_t start_ns_ = 0;
};

}  // namespace sandhopper::bench
