#pragma once
#include <string>

#include "drivers/i2c/i2c_bus.hpp"
#include "drivers/unique_fd.hpp"

namespace sandhopper {

// An i2c-dev node, by I2C_RDWR, with short time-out and no retries: a stuck bus must not hold its thread.
// Throws DeviceError, also when a kernel driver owns `address`.
class I2cDevice : public I2cBus {
 public:
  I2cDevice(const std::string& path, std::uint8_t address);
  bool write(std::uint8_t address, std::span<const std::uint8_t> bytes) noexcept override;
  bool read(std::uint8_t address, std::span<std::uint8_t> bytes) noexcept override;

 private:
  bool transfer(std::uint8_t address, std::uint16_t flags, std::uint8_t* bytes, std::size_t size) noexcept;

  UniqueFd fd_;
};

}  // namespace sandhopper
