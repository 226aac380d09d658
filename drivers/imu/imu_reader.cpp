#include "drivers/imu/imu_reader.hpp"

#include "drivers/clock.hpp"

namespace sandhopper {

namespace {
constexpr std::int64_t kEdgeTimeout_ns = 20'000'000;
}

ImuReader::ImuReader(const std::string& role, const ImuConfig& config)
    : config_(config),
      bus_(config.device, config.spi_speed_Hz),
      sensor_(role + " (" + config.device + ")", bus_, config) {
  if (config.data_ready.fitted()) edges_.emplace(role + " data-ready", config.data_ready);
  sensor_.start();
  if (edges_) edges_->wait(0);  // discard edges from before the start
}

bool ImuReader::acquire(ImuSample& sample) noexcept {
  return edges_ ? acquire_on_edge(sample) : acquire_by_polling(sample);
}

bool ImuReader::acquire_on_edge(ImuSample& sample) noexcept {
  const auto edge = edges_->wait(kEdgeTimeout_ns);
  const auto now = monotonic_ns();
  ism330dhcx::Burst burst;
  if (!read(burst)) return false;
  if (edge) return finish(sample, burst, edge->time_ns, edge->count);
  ++counters_.missed_edges;
  return burst.accel_ready() && finish(sample, burst, now, 1);
}

bool ImuReader::acquire_by_polling(ImuSample& sample) noexcept {
  sleep_ns(to_ns(config_.poll_period_s));
  const auto now = monotonic_ns();
  ism330dhcx::Burst burst;
  return read(burst) && burst.accel_ready() && finish(sample, burst, now, 1);
}

bool ImuReader::read(ism330dhcx::Burst& burst) noexcept {
  if (sensor_.read(burst)) return true;
  ++counters_.failed_transfers;
  sleep_ns(kEdgeTimeout_ns);  // if the bus has failed, sleep so that the thread does not spin
  return false;
}

bool ImuReader::finish(ImuSample& sample, const ism330dhcx::Burst& burst, std::int64_t ready_ns,
                       std::uint32_t new_samples) noexcept {
  samples_ += new_samples;
  sample = ism330dhcx::to_sample(burst, config_);
  sample.time_ns = ready_ns - to_ns(config_.latency_s);
  sample.samples = samples_;
  return true;
}

}  // namespace sandhopper
