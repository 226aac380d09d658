#pragma once
#include <string>

#include "drivers/i2c/i2c_bus.hpp"
#include "drivers/unique_fd.hpp"

namespace sandhopper {

// An i2c-dev node, used with I2C_RDWR, a short timeout and no retries, so that a stuck bus does not block its
// thread. Throws DeviceError, also if a kernel driver owns `address`.
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
