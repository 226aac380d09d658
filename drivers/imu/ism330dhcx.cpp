#include "drivers/imu/ism330dhcx.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "drivers/clock.hpp"
#include "drivers/device_error.hpp"

namespace sandhopper {

using namespace ism330dhcx;

namespace {
constexpr std::int64_t kMillisecond_ns = 1'000'000;
constexpr std::int64_t kResetWait_ns = 50 * kMillisecond_ns;
constexpr std::int64_t kSettle_ns = 100 * kMillisecond_ns;
constexpr int kResetTries = 20;
// The chip answers within 10 ms after power-on (datasheet). Its identity is read once per millisecond until
// then.
constexpr int kIdentityTries = 10;

bool no_answer(std::uint8_t identity) { return identity == 0x00 || identity == 0xFF; }

std::string hex(std::uint8_t value) {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "0x%02X", value);
  return text.data();
}
}  // namespace

Ism330dhcx::Ism330dhcx(std::string role, SpiBus& bus, const ImuConfig& config)
    : role_(std::move(role)), bus_(bus), config_(config), actual_rate_Hz_(config.rate_Hz) {}

void Ism330dhcx::start() {
  identify();
  reset();
  const auto settings = settings_of(config_);
  for (const auto& [address, value] : settings) write_register(address, value);
  for (const auto& [address, value] : settings)
    if (const auto got = read_register(address); got != value)
      throw DeviceError(role_,
                        "register " + hex(address) + " holds " + hex(got) + " after writing " + hex(value),
                        "Check the wiring (MOSI) and lower spi_speed_Hz");
  actual_rate_Hz_ =
      ism330dhcx::actual_rate_Hz(config_, static_cast<std::int8_t>(read_register(kInternalFreqFine)));
  sleep_ns(kSettle_ns);
}

std::uint8_t Ism330dhcx::read_identity() {
  std::uint8_t who = read_register(kWhoAmI);
  for (int i = 1; no_answer(who) && i < kIdentityTries; ++i) {
    sleep_ns(kMillisecond_ns);
    who = read_register(kWhoAmI);
  }
  return who;
}

// After a restart of the host or the supply the chip may answer only to a reset.
void Ism330dhcx::identify() {
  auto who = read_identity();
  if (no_answer(who)) {
    begin_reset();
    sleep_ns(kResetWait_ns);
    who = read_identity();
  }
  if (who != kWhoAmIValue)
    throw DeviceError(
        role_,
        "WHO_AM_I reads " + hex(who) + " instead of 0x6B" + (no_answer(who) ? ", after a reset, too" : ""),
        no_answer(who) ? "Nothing answers: check power, chip select, and that it is this sensor's spidev node"
                       : "Another part is on this chip select: check imu device names and wiring");
}

void Ism330dhcx::begin_reset() {
  write_register(kFuncCfgAccess, 0x00);
  write_register(kFifoCtrl4, 0x00);
  write_register(kCtrl3C, kSoftwareReset);
}

void Ism330dhcx::reset() {
  begin_reset();
  for (int i = 0; (read_register(kCtrl3C) & kSoftwareReset) != 0; ++i) {
    if (i == kResetTries)
      throw DeviceError(role_, "software reset does not finish", "Power-cycle the sensor");
    sleep_ns(kMillisecond_ns);
  }
  sleep_ns(kResetWait_ns);
  write_register(kCtrl3C, kReboot);
  sleep_ns(kResetWait_ns);
}

bool Ism330dhcx::read(Burst& burst) noexcept {
  std::array<std::uint8_t, kBurstSize> bytes{};
  if (!read_registers(kStatus, bytes)) return false;
  burst = decode_burst(bytes);
  return true;
}

bool Ism330dhcx::read_registers(std::uint8_t address, std::span<std::uint8_t> values) noexcept {
  std::array<std::uint8_t, kBurstSize + 1> out{static_cast<std::uint8_t>(address | kReadFlag)};
  std::array<std::uint8_t, kBurstSize + 1> in{};
  const auto size = values.size() + 1;
  if (!bus_.transfer(std::span(out).first(size), std::span(in).first(size))) return false;
  std::copy_n(in.begin() + 1, values.size(), values.begin());
  return true;
}

std::uint8_t Ism330dhcx::read_register(std::uint8_t address) {
  std::array<std::uint8_t, 1> value{};
  if (!read_registers(address, value))
    throw DeviceError(role_, errno_cause("SPI transfer failed"),
                      "Check the bus: dmesg, spi_speed_Hz, wiring");
  return value[0];
}

void Ism330dhcx::write_register(std::uint8_t address, std::uint8_t value) {
  const std::array<std::uint8_t, 2> out{address, value};
  std::array<std::uint8_t, 2> in{};
  if (!bus_.transfer(out, in))
    throw DeviceError(role_, errno_cause("SPI transfer failed"),
                      "Check the bus: dmesg, spi_speed_Hz, wiring");
}

}  // namespace sandhopper
