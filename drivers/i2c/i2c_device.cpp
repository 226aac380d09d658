#include "drivers/i2c/i2c_device.hpp"

#include <fcntl.h>
#include <linux/i2c-dev.h>
#include <linux/i2c.h>
#include <sys/ioctl.h>

#include <cerrno>

#include "drivers/device_error.hpp"

namespace sandhopper {

namespace {
constexpr unsigned long kTimeout_10ms = 1;
}

I2cDevice::I2cDevice(const std::string& path, std::uint8_t address)
    : fd_(::open(path.c_str(), O_RDWR | O_CLOEXEC)) {
  if (!fd_)
    throw DeviceError(
        path, errno_cause("cannot open"),
        "Enable the I2C bus and load i2c-dev so that i2cdetect -l shows it, run as root or in group "
        "i2c, or name another device in the board's file");
  unsigned long functions = 0;
  if (::ioctl(fd_.get(), I2C_FUNCS, &functions) != 0 || (functions & I2C_FUNC_I2C) == 0)
    throw DeviceError(path, "the adapter does SMBus commands only",
                      "Use an adapter with plain I2C transfers");
  if (::ioctl(fd_.get(), I2C_SLAVE, static_cast<unsigned long>(address)) != 0 && errno == EBUSY)
    throw DeviceError(path, "a kernel driver owns address " + std::to_string(address),
                      "Unbind it (ls /sys/bus/i2c/devices shows which) or take it out of the device tree");
  ::ioctl(fd_.get(), I2C_TIMEOUT, kTimeout_10ms);
  ::ioctl(fd_.get(), I2C_RETRIES, 0UL);
}

bool I2cDevice::write(std::uint8_t address, std::span<const std::uint8_t> bytes) noexcept {
  return transfer(address, 0, const_cast<std::uint8_t*>(bytes.data()), bytes.size());
}

bool I2cDevice::read(std::uint8_t address, std::span<std::uint8_t> bytes) noexcept {
  return transfer(address, I2C_M_RD, bytes.data(), bytes.size());
}

bool I2cDevice::transfer(std::uint8_t address, std::uint16_t flags, std::uint8_t* bytes,
                         std::size_t size) noexcept {
  i2c_msg message{address, flags, static_cast<std::uint16_t>(size), bytes};
  i2c_rdwr_ioctl_data data{&message, 1};
  return ::ioctl(fd_.get(), I2C_RDWR, &data) == 1;
}

}  // namespace sandhopper
