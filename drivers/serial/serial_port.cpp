#include "drivers/serial/serial_port.hpp"

#include <fcntl.h>
#include <poll.h>
#include <termios.h>

#include <algorithm>
#include <array>

#include "drivers/clock.hpp"
#include "drivers/device_error.hpp"

namespace sandhopper {

namespace {

struct Speed {
  int baud;
  speed_t code;
};
constexpr std::array<Speed, 8> kSpeeds{{{115200, B115200},
                                        {230400, B230400},
                                        {460800, B460800},
                                        {500000, B500000},
                                        {921600, B921600},
                                        {1000000, B1000000},
                                        {1500000, B1500000},
                                        {2000000, B2000000}}};

}  // namespace

SerialPort::SerialPort(const std::string& path, int baud)
    : fd_(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
  if (!fd_)
    throw DeviceError(
        path, errno_cause("cannot open"),
        "Plug in or power the companion controller (ls /dev/ttyACM* /dev/ttyAMA*), run as root or in "
        "group dialout, or name another device in the board's file");
  const auto speed = std::ranges::find(kSpeeds, baud, &Speed::baud);
  if (speed == kSpeeds.end())
    throw DeviceError(path, std::to_string(baud) + " baud is not a serial line's speed",
                      "Use 115200 to 2000000");
  termios settings{};
  if (::tcgetattr(fd_.get(), &settings) != 0)
    throw DeviceError(path, errno_cause("not a serial line"),
                      "Name the companion controller's serial device");
  ::cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(CRTSCTS | CSTOPB);
  if (::cfsetspeed(&settings, speed->code) != 0 || ::tcsetattr(fd_.get(), TCSANOW, &settings) != 0)
    throw DeviceError(path, errno_cause("cannot set " + std::to_string(baud) + " baud"),
                      "Use a speed the adapter and the companion controller both have");
}

bool SerialPort::wait(std::int64_t timeout_ns) const noexcept {
  pollfd p{fd_.get(), POLLIN, 0};
  const timespec timeout{timeout_ns / kNanosecondsPerSecond, timeout_ns % kNanosecondsPerSecond};
  return ::ppoll(&p, 1, &timeout, nullptr) > 0;
}

std::size_t SerialPort::read(std::span<std::uint8_t> bytes) noexcept {
  const auto count = ::read(fd_.get(), bytes.data(), bytes.size());
  return count > 0 ? static_cast<std::size_t>(count) : 0;
}

bool SerialPort::write(std::span<const std::uint8_t> bytes) noexcept {
  return ::write(fd_.get(), bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
}

void SerialPort::discard_input() noexcept { ::tcflush(fd_.get(), TCIFLUSH); }

}  // namespace sandhopper
