#pragma once
#include <string>

#include "drivers/spi/spi_bus.hpp"
#include "drivers/unique_fd.hpp"

namespace sandhopper {

// A spidev node in mode 3 with 8-bit words. Throws DeviceError.
class SpiDevice : public SpiBus {
 public:
  SpiDevice(const std::string& path, int speed_Hz);
  bool transfer(std::span<const std::uint8_t> out, std::span<std::uint8_t> in) noexcept override;

 private:
  UniqueFd fd_;
  std::uint32_t speed_Hz_;
};

}  // namespace sandhopper
