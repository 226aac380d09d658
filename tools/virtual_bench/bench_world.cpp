#include "tools/virtual_bench/bench_world.hpp"

#include <algorithm>

#include "drivers/clock.hpp"

namespace sandhopper::bench {

BenchWorld::BenchWorld(EventLoop& loop, const WorldConfig& config, const TrialSetup& setup)
    : loop_(loop), config_(config) {
  config_.sensors.imu_resolution_mps2 = 0.0;  // the emulated chip rounds, once and to its own grid
  reset(setup);
}

void BenchWorld::reset(const TrialSetup& setup) {
  // Whole milliseconds, as the firmware's cycle has: a trial does not depend on when within one it was reset.
  constexpr std::int64_t kMillisecond_ns = 1'000'000;
  const auto start_ns = (monotonic_ns() / kMillisecond_ns + 1) * kMillisecond_ns;
  world_ = std::make_unique<World>(config_, setup, start_ns);
  start_ns_ = start_ns;
  setup_ = setup;
  for (std::size_t i = 0; i < kMotorCount; ++i)
    world_->command(static_cast<Side>(i), commands_[i].command, commands_[i].enabled);
  if (on_reset) on_reset();
  wake_at_next_completion();
}

World& BenchWorld::now() {
  advance();
  return *world_;
}

void BenchWorld::command(Side side, const MotorCommand& command, bool enabled) {
  commands_[static_cast<std::size_t>(side)] = {command, enabled};
  now().command(side, command, enabled);
}

void BenchWorld::advance() {
  const auto now_ns = loop_.now_ns();
  while (world_->next_sample_ns() <= now_ns) {
    world_->advance_to(world_->next_sample_ns());
    publish();
  }
  world_->advance_to(now_ns);
}

template <class Sample>
void BenchWorld::publish_new(const Sample& sample, Outlet<Sample>& outlet) {
  if (sample.time_ns == outlet.newest_ns || sample.time_ns == 0) return;
  outlet.newest_ns = sample.time_ns;
  if (outlet.complete)
    loop_.at(sample.time_ns + outlet.delay_ns, [&outlet, sample] { outlet.complete(sample); });
}

void BenchWorld::publish() {
  publish_new(world_->imu_body(), imu_body);
  publish_new(world_->imu_foot(), imu_foot);
  publish_new(world_->tof(), tof);
  publish_new(world_->load_cell(), load_cell);
}

std::int64_t BenchWorld::next_completion_ns() const noexcept {
  const auto next = world_->next_samples();
  const auto completion_ns = [this](std::int64_t measured_ns, std::int64_t available_ns,
                                    std::int64_t delay_ns) {
    const auto steps = (available_ns - start_ns_ + World::kStep_ns - 1) / World::kStep_ns;
    return std::max(start_ns_ + steps * World::kStep_ns, measured_ns + delay_ns);
  };
  const auto tof_latency_ns = to_ns(config_.sensors.tof_latency_s);
  return std::min({completion_ns(next.imu_body_ns, next.imu_body_ns, imu_body.delay_ns),
                   completion_ns(next.imu_foot_ns, next.imu_foot_ns, imu_foot.delay_ns),
                   completion_ns(next.tof_ns - tof_latency_ns, next.tof_ns, tof.delay_ns),
                   completion_ns(next.load_cell_ns, next.load_cell_ns, load_cell.delay_ns)});
}

void BenchWorld::wake_at_next_completion() {
  loop_.at(next_completion_ns(), [this, world = world_.get()] {
    if (world != world_.get()) return;  // it was reset since
    advance();
    wake_at_next_completion();
  });
}

}  // namespace sandhopper::bench
