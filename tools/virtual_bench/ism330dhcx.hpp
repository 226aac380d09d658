#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "drivers/imu/imu_config.hpp"
#include "drivers/samples.hpp"
#include "tools/virtual_bench/event_loop.hpp"
#include "tools/virtual_bench/sample_rate.hpp"
#include "tools/virtual_bench/simulated_gpio.hpp"
#include "tools/virtual_bench/spi_node.hpp"

namespace sandhopper::bench {

// ISM330DHCX at register level: identity, software reset, rate and full scale of accelerometer and gyro,
// status, outputs with the part's own scale, rounding and saturation, temperature, time stamp, data-ready on
// INT1 latched until read or pulsed. Filters do not filter (the world's sensor has its bandwidth), there is
// no FIFO, and data are right from the first sample on. Registers: ST's ism330dhcx driver header.
class Ism330dhcx : public SpiChip {
 public:
  struct Wiring {
    EventLoop& loop;
    SimulatedLine& data_ready;
  };
  // `config` gives the mounting and the line's polarity; all else the firmware sets through registers.
  Ism330dhcx(const Wiring& wiring, const ImuConfig& config, double world_rate_Hz);

  // A measurement is complete, now.
  void complete(const ImuSample& sample);

  void transfer(std::span<const std::uint8_t> in, std::span<std::uint8_t> out) override;

 private:
  void reset();
  std::uint8_t read_register(std::uint8_t address);
  void write_register(std::uint8_t address, std::uint8_t value);
  // What the configuration takes off again: delivered = true / scale + bias.
  struct Flaws {
    std::array<double, 3> scale, bias;
  };
  void put(std::uint8_t address, const std::array<double, 3>& robot_axes, const Flaws& flaws, double unit);
  void show_data_ready(bool new_sample);
  std::uint32_t timestamp() const noexcept;
  double accel_unit_mps2() const noexcept;
  double gyro_unit_radps() const noexcept;

  Wiring wiring_;
  ImuConfig config_;
  SampleRate accel_rate_;
  SampleRate gyro_rate_;
  std::array<std::uint8_t, 128> register_{};
  std::int64_t reset_until_ns_ = 0;
  std::int64_t timestamp_zero_ns_ = 0;
};

}  // namespace sandhopper::bench
