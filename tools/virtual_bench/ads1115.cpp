#include "tools/virtual_bench/ads1115.hpp"

#include <algorithm>
#include <cmath>

namespace sandhopper::bench {
namespace {

constexpr std::uint16_t kStart = 0x8000;  // written: start; read: idle
constexpr std::uint16_t kSingleShot = 0x0100;
constexpr std::uint16_t kActiveHigh = 0x0008;
constexpr std::uint16_t kQueueOff = 0x0003;
constexpr std::array kFullScale_V{6.144, 4.096, 2.048, 1.024, 0.512, 0.256, 0.256, 0.256};
constexpr std::array kRate_Hz{8.0, 16.0, 32.0, 64.0, 128.0, 250.0, 475.0, 860.0};

std::size_t field(std::uint16_t value, int shift) { return (value >> shift) & 7U; }

}  // namespace

Ads1115::Ads1115(const Wiring& wiring, const LoadCellConfig& config, double world_rate_Hz)
    : wiring_(wiring), load_cell_(config), rate_(world_rate_Hz) {
  wiring_.alert.drive(true);  // open drain with a pull-up
}

std::int16_t Ads1115::convert(double force_N) const {
  const bool selected = field(register_[config], 12) == static_cast<std::size_t>(load_cell_.input);
  const double volts =
      selected ? load_cell_.zero_V + load_cell_.sign * force_N / load_cell_.scale_N_per_V : 0.0;
  const double counts = volts / kFullScale_V[field(register_[config], 9)] * 32768.0;
  return static_cast<std::int16_t>(std::lround(std::clamp(counts, -32768.0, 32767.0)));
}

void Ads1115::complete(const LoadCellSample& sample) {
  if ((register_[config] & kSingleShot) != 0) {
    if (!single_shot_running_ || wiring_.loop.now_ns() < single_shot_done_ns_) return;
    single_shot_running_ = false;
  } else if (!rate_.takes_next(kRate_Hz[field(register_[config], 5)])) {
    return;
  }
  register_[conversion] = static_cast<std::uint16_t>(convert(sample.force_N));
  show_ready();
}

// Of the 8 us pulse only the edges are kept. In single-shot mode the pin stays active until the next start.
void Ads1115::show_ready() {
  const bool ready_pin =
      (register_[high_threshold] & 0x8000) != 0 && (register_[low_threshold] & 0x8000) == 0;
  if (!ready_pin || (register_[config] & kQueueOff) == kQueueOff) return;
  const bool active = (register_[config] & kActiveHigh) != 0;
  wiring_.alert.drive(active);
  if ((register_[config] & kSingleShot) == 0) wiring_.alert.drive(!active);
}

void Ads1115::configure(std::uint16_t value) {
  const bool single_shot = (value & kSingleShot) != 0;
  if (single_shot && (value & kStart) != 0) {
    single_shot_running_ = true;
    single_shot_done_ns_ = wiring_.loop.now_ns() + static_cast<std::int64_t>(1e9 / kRate_Hz[field(value, 5)]);
  }
  if (!single_shot) single_shot_running_ = false;
  register_[config] = static_cast<std::uint16_t>(value & ~kStart);
  const bool off = (value & kQueueOff) == kQueueOff;
  wiring_.alert.drive(off || (value & kActiveHigh) == 0);
}

void Ads1115::write(std::span<const std::uint8_t> in) {
  if (in.empty()) return;
  pointer_ = in[0] & 3U;
  if (in.size() < 3 || pointer_ == conversion) return;
  const auto value = static_cast<std::uint16_t>(in[1] << 8 | in[2]);
  if (pointer_ == config)
    configure(value);
  else
    register_[pointer_] = value;
}

void Ads1115::read(std::span<std::uint8_t> out) {
  std::uint16_t value = register_[pointer_];
  const bool idle = (register_[config] & kSingleShot) != 0 && !single_shot_running_;
  if (pointer_ == config && idle) value |= kStart;
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = static_cast<std::uint8_t>(i % 2 == 0 ? value >> 8 : value & 0xFF);
}

}  // namespace sandhopper::bench
