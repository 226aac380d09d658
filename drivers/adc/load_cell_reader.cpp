#include "drivers/adc/load_cell_reader.hpp"

#include <algorithm>

#include "drivers/clock.hpp"

namespace sandhopper {

namespace {
// Two conversions at the slowest rates, so that only an edge that failed to come is counted. At least 50 ms.
std::int64_t edge_timeout_ns(const LoadCellConfig& config) {
  return std::max(to_ns(2.0 * ads1115_period_s(config.rate)), std::int64_t{50'000'000});
}

std::string role_of(const LoadCellConfig& config) {
  return "load_cell (ADS1115 at address " + std::to_string(config.address) + " of " + config.device + ")";
}
}  // namespace

LoadCellReader::LoadCellReader(const LoadCellConfig& config)
    : config_(config),
      bus_(config.device, static_cast<std::uint8_t>(config.address)),
      converter_(role_of(config), bus_, config),
      edges_("load_cell ready", config.ready) {
  converter_.start();
  edges_.wait(0);  // discard edges from before the start
}

bool LoadCellReader::acquire(LoadCellSample& sample) noexcept {
  const auto edge = edges_.wait(edge_timeout_ns(config_));
  if (!edge) {
    ++counters_.missed_edges;
    return false;
  }
  std::int16_t counts = 0;
  if (!converter_.read(counts)) {
    ++counters_.failed_transfers;
    return false;
  }
  samples_ += edge->count;
  sample = {edge->time_ns - to_ns(config_.latency_s), load_cell_force_N(config_, counts), samples_, true};
  return true;
}

}  // namespace sandhopper
