#include "drivers/adc/ads1115.hpp"

#include <array>
#include <utility>

#include "drivers/device_error.hpp"

namespace sandhopper {

namespace {
constexpr unsigned kStateBit = 0x8000;  // of the config register: reads 1 while idle, whatever was written
}

std::uint16_t ads1115_config_word(const LoadCellConfig& c) noexcept {
  const auto mux = static_cast<unsigned>(c.input);
  const auto gain = static_cast<unsigned>(c.range);
  const auto rate = static_cast<unsigned>(c.rate);
  return static_cast<std::uint16_t>((mux << 12U) | (gain << 9U) | (rate << 5U));
}

double ads1115_full_scale_V(AdcRange range) noexcept {
  constexpr std::array kFullScale_V{6.144, 4.096, 2.048, 1.024, 0.512, 0.256};
  return kFullScale_V[static_cast<std::size_t>(range)];
}

double ads1115_period_s(AdcRate rate) noexcept {
  constexpr std::array kRate_Hz{8.0, 16.0, 32.0, 64.0, 128.0, 250.0, 475.0, 860.0};
  return 1.0 / kRate_Hz[static_cast<std::size_t>(rate)];
}

double load_cell_force_N(const LoadCellConfig& c, std::int16_t counts) noexcept {
  return c.sign * c.scale_N_per_V * (counts * ads1115_full_scale_V(c.range) / 32768.0 - c.zero_V);
}

Ads1115::Ads1115(std::string role, I2cBus& bus, const LoadCellConfig& config)
    : role_(std::move(role)),
      bus_(bus),
      config_(config),
      address_(static_cast<std::uint8_t>(config.address)) {}

void Ads1115::start() {
  // Setting the high bit of the high threshold and clearing that of the low one makes the pin signal "ready",
  // not a limit.
  write_register(kAds1115HighThreshold, 0x8000);
  write_register(kAds1115LowThreshold, 0x0000);
  const auto word = ads1115_config_word(config_);
  write_register(kAds1115Config, word);
  const auto got = read_register(kAds1115Config);
  if ((got & ~kStateBit) != word)
    throw DeviceError(role_, "the configuration does not read back",
                      "Another chip answers at this address: check load_cell.address and the ADDR pin");
  const std::array<std::uint8_t, 1> pointer{kAds1115Conversion};
  if (!bus_.write(address_, pointer)) fail("cannot set the pointer");
}

bool Ads1115::read(std::int16_t& counts) noexcept {
  std::array<std::uint8_t, 2> bytes{};
  if (!bus_.read(address_, bytes)) return false;
  counts = static_cast<std::int16_t>((bytes[0] << 8) | bytes[1]);
  return true;
}

void Ads1115::write_register(std::uint8_t reg, std::uint16_t value) {
  const std::array<std::uint8_t, 3> bytes{reg, static_cast<std::uint8_t>(value >> 8U),
                                          static_cast<std::uint8_t>(value & 0xFFU)};
  if (!bus_.write(address_, bytes)) fail("no answer");
}

std::uint16_t Ads1115::read_register(std::uint8_t reg) {
  const std::array<std::uint8_t, 1> pointer{reg};
  std::array<std::uint8_t, 2> bytes{};
  if (!bus_.write(address_, pointer) || !bus_.read(address_, bytes)) fail("cannot read");
  return static_cast<std::uint16_t>((bytes[0] << 8) | bytes[1]);
}

void Ads1115::fail(const char* action) const {
  throw DeviceError(role_, errno_cause(action),
                    "Check power, pull-ups and the ADDR pin: i2cdetect -y BUS must show load_cell.address");
}

}  // namespace sandhopper
