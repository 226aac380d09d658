#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "drivers/adc/load_cell_config.hpp"
#include "drivers/samples.hpp"
#include "tools/virtual_bench/event_loop.hpp"
#include "tools/virtual_bench/i2c_node.hpp"
#include "tools/virtual_bench/sample_rate.hpp"
#include "tools/virtual_bench/simulated_gpio.hpp"

namespace sandhopper::bench {

// ADS1115 at register level with the load cell's amplifier on its configured input and nothing on the others:
// pointer, conversion, configuration and threshold registers, continuous and single-shot conversion, gain
// with rounding and saturation, ALERT/RDY as conversion-ready (not as a comparator). Conversions end when the
// world's load cell is sampled. Registers: TI's datasheet SBAS444, section 9.6.
class Ads1115 : public I2cChip {
 public:
  struct Wiring {
    EventLoop& loop;
    SimulatedLine& alert;
  };
  Ads1115(const Wiring& wiring, const LoadCellConfig& config, double world_rate_Hz);

  // A conversion is complete, now.
  void complete(const LoadCellSample& sample);

  void write(std::span<const std::uint8_t> in) override;
  void read(std::span<std::uint8_t> out) override;

 private:
  enum Register : std::size_t { conversion, config, low_threshold, high_threshold };

  std::int16_t convert(double force_N) const;
  void configure(std::uint16_t value);
  void show_ready();

  Wiring wiring_;
  LoadCellConfig load_cell_;
  SampleRate rate_;
  std::array<std::uint16_t, 4> register_{0x0000, 0x8583, 0x8000, 0x7FFF};
  std::size_t pointer_ = conversion;
  std::int64_t single_shot_done_ns_ = 0;
  bool single_shot_running_ = false;
};

}  // namespace sandhopper::bench
