#pragma once
#include <cstdint>
#include <span>

namespace sandhopper {

class I2cBus {
 public:
  virtual ~I2cBus() = default;
  // One message to or from a 7-bit address. False when it failed.
  virtual bool write(std::uint8_t address, std::span<const std::uint8_t> bytes) noexcept = 0;
  virtual bool read(std::uint8_t address, std::span<std::uint8_t> bytes) noexcept = 0;
};

}  // namespace sandhopper
