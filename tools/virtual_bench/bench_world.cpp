#include "tools/virtual_bench/bench_world.hpp"

#include "drivers/clock.hpp"

namespace sandhopper::bench {
namespace {

template <class Sample>
void publish_new(const Sample& sample, std::int64_t& published_ns,
                 const std::function<void(const Sample&)>& listener) {
  if (sample.time_ns == published_ns || sample.time_ns == 0) return;
  published_ns = sample.time_ns;
  if (listener) listener(sample);
}

}  // namespace

BenchWorld::BenchWorld(EventLoop& loop, const WorldConfig& config, const TrialSetup& setup)
    : loop_(loop), config_(config) {
  reset(setup);
}

void BenchWorld::reset(const TrialSetup& setup) {
  // On whole milliseconds, as the firmware's cycle is, so that a trial does not depend on when it was reset.
  constexpr std::int64_t kMillisecond_ns = 1'000'000;
  const auto start_ns = (monotonic_ns() / kMillisecond_ns + 1) * kMillisecond_ns;
  world_ = std::make_unique<World>(config_, setup, start_ns);
  setup_ = setup;
  published_ = {};
  for (std::size_t i = 0; i < kMotorCount; ++i)
    world_->command(static_cast<Side>(i), told_[i].command, told_[i].enabled);
  for (const auto& listener : on_reset) listener();
  schedule();
}

World& BenchWorld::now() {
  advance();
  return *world_;
}

void BenchWorld::command(Side side, const MotorCommand& command, bool enabled) {
  told_[static_cast<std::size_t>(side)] = {command, enabled};
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

void BenchWorld::publish() {
  publish_new(world_->imu_body(), published_.imu_body_ns, on_imu_body);
  publish_new(world_->imu_foot(), published_.imu_foot_ns, on_imu_foot);
  publish_new(world_->tof(), published_.tof_ns, on_tof);
  publish_new(world_->load_cell(), published_.load_cell_ns, on_load_cell);
}

void BenchWorld::schedule() {
  if (world_->next_sample_ns() == scheduled_ns_) return;
  scheduled_ns_ = world_->next_sample_ns();
  loop_.at(scheduled_ns_, [this, for_ns = scheduled_ns_] {
    if (for_ns != scheduled_ns_) return;  // of a world that was reset since
    advance();
    schedule();
  });
}

}  // namespace sandhopper::bench
