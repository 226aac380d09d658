#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "tools/plant/world.hpp"
#include "tools/virtual_bench/event_loop.hpp"

namespace sandhopper::bench {

// The plant on the bench's clock. Every emulated device sees and moves the same one. It is stepped lazily: up
// to now whenever a device looks at it, and at least whenever a sensor has a new sample.
class BenchWorld {
 public:
  BenchWorld(EventLoop& loop, const WorldConfig& config, const TrialSetup& setup);

  // The world as of now.
  World& now();

  // A new world with the body held again. Keeps what the drives were told.
  void reset(const TrialSetup& setup);
  const TrialSetup& setup() const noexcept { return setup_; }
  const WorldConfig& config() const noexcept { return config_; }

  bool released() const noexcept { return world_->truth().released; }

  void command(Side side, const MotorCommand& command, bool enabled);

  // Called with each new sample, on the plant's grid: up to 0.1 ms after its own time stamp.
  std::function<void(const ImuSample&)> on_imu_body;
  std::function<void(const ImuSample&)> on_imu_foot;
  std::function<void(const TofSample&)> on_tof;
  std::function<void(const LoadCellSample&)> on_load_cell;
  // Called after a reset.
  std::vector<std::function<void()>> on_reset;

 private:
  struct Told {
    MotorCommand command;
    bool enabled = false;
  };
  struct Published {
    std::int64_t imu_body_ns = 0, imu_foot_ns = 0, tof_ns = 0, load_cell_ns = 0;
  };

  void advance();
  void publish();
  void schedule();

  EventLoop& loop_;
  WorldConfig config_;
  TrialSetup setup_;
  std::unique_ptr<World> world_;
  std::array<Told, kMotorCount> told_{};
  Published published_{};
  std::int64_t scheduled_ns_ = -1;
};

}  // namespace sandhopper::bench
