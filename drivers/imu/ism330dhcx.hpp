#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "drivers/imu/ism330dhcx_protocol.hpp"
#include "drivers/spi/spi_bus.hpp"

namespace sandhopper {

// The sensor behind an SPI bus. `role` names it in messages.
class Ism330dhcx {
 public:
  Ism330dhcx(std::string role, SpiBus& bus, const ImuConfig& config);

  // Identifies, resets and sets up the sensor, reads its settings back and lets it settle: about 0.2 s. A
  // sensor whose identity reads 0x00 or 0xFF is read again for 10 ms, then reset and read again.
  // Throws DeviceError.
  void start();

  bool read(ism330dhcx::Burst& burst) noexcept;

  double actual_rate_Hz() const noexcept { return actual_rate_Hz_; }

 private:
  bool read_registers(std::uint8_t address, std::span<std::uint8_t> values) noexcept;
  std::uint8_t read_register(std::uint8_t address);
  void write_register(std::uint8_t address, std::uint8_t value);
  std::uint8_t read_identity();
  void identify();
  void begin_reset();
  void reset();

  std::string role_;
  SpiBus& bus_;
  ImuConfig config_;
  double actual_rate_Hz_;
};

}  // namespace sandhopper
