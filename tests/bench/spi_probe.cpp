// Reads an ISM330DHCX through spidev without the driver: spi_probe DEVICE [SAMPLES]. Prints the identity,
// then the acceleration along z in m/s^2 of SAMPLES samples (default 1), polled by the status register.
#include <fcntl.h>
#include <linux/spi/spidev.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>

namespace {

void pause_ns(long duration_ns) {
  const timespec duration{0, duration_ns};
  ::nanosleep(&duration, nullptr);
}

bool transfer(int fd, std::span<std::uint8_t> bytes) {
  spi_ioc_transfer message{};
  message.tx_buf = reinterpret_cast<std::uintptr_t>(bytes.data());
  message.rx_buf = message.tx_buf;
  message.len = static_cast<std::uint32_t>(bytes.size());
  return ::ioctl(fd, SPI_IOC_MESSAGE(1), &message) == static_cast<int>(bytes.size());
}

bool write_register(int fd, std::uint8_t address, std::uint8_t value) {
  std::array<std::uint8_t, 2> bytes{address, value};
  return transfer(fd, bytes);
}

// Returns the byte received during the address, then the registers.
template <std::size_t N>
std::array<std::uint8_t, N + 1> read_registers(int fd, std::uint8_t address) {
  std::array<std::uint8_t, N + 1> bytes{static_cast<std::uint8_t>(address | 0x80)};
  if (!transfer(fd, bytes)) std::exit(1);
  return bytes;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  const int fd = ::open(argv[1], O_RDWR);
  if (fd < 0) return 1;
  int samples = argc > 2 ? std::atoi(argv[2]) : 1;
  std::printf("WHO_AM_I 0x%02X\n", read_registers<1>(fd, 0x0F)[1]);
  write_register(fd, 0x0D, 0x01);  // accelerometer data-ready on INT1
  write_register(fd, 0x10, 0x84);  // accelerometer at 1666 Hz, 16 g
  while (samples > 0) {
    pause_ns(100'000);
    if ((read_registers<1>(fd, 0x1E)[1] & 0x01) == 0) continue;
    const auto bytes = read_registers<6>(fd, 0x28);
    const auto z = static_cast<std::int16_t>(bytes[5] | bytes[6] << 8);
    std::printf("accel_z %.4f\n", z * 0.488e-3 * 9.80665);
    --samples;
  }
  return 0;
}
