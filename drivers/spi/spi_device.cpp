#include "drivers/spi/spi_device.hpp"

#include <fcntl.h>
#include <linux/spi/spidev.h>
#include <sys/ioctl.h>

#include "drivers/device_error.hpp"

namespace sandhopper {

SpiDevice::SpiDevice(const std::string& path, int speed_Hz)
    : fd_(::open(path.c_str(), O_RDWR | O_CLOEXEC)), speed_Hz_(static_cast<std::uint32_t>(speed_Hz)) {
  if (!fd_)
    throw DeviceError(
        path, errno_cause("cannot open"),
        "Enable the SPI bus in the device tree so that ls /dev/spidev* shows it, run as root or in "
        "group spi, or name another device in the board's file");
  const std::uint8_t mode = SPI_MODE_3;
  const std::uint8_t bits = 8;
  if (::ioctl(fd_.get(), SPI_IOC_WR_MODE, &mode) != 0 ||
      ::ioctl(fd_.get(), SPI_IOC_WR_BITS_PER_WORD, &bits) != 0 ||
      ::ioctl(fd_.get(), SPI_IOC_WR_MAX_SPEED_HZ, &speed_Hz_) != 0)
    throw DeviceError(
        path, errno_cause("cannot set SPI mode 3, 8 bits, " + std::to_string(speed_Hz) + " Hz"),
        "Check that it is a spidev node and that the controller can do this speed (spi_speed_Hz)");
}

bool SpiDevice::transfer(std::span<const std::uint8_t> out, std::span<std::uint8_t> in) noexcept {
  spi_ioc_transfer message{};
  message.tx_buf = reinterpret_cast<std::uintptr_t>(out.data());
  message.rx_buf = reinterpret_cast<std::uintptr_t>(in.data());
  message.len = static_cast<std::uint32_t>(out.size());
  message.speed_hz = speed_Hz_;
  message.bits_per_word = 8;
  return ::ioctl(fd_.get(), SPI_IOC_MESSAGE(1), &message) >= 0;
}

}  // namespace sandhopper
