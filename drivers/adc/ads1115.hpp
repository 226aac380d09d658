#pragma once
#include <cstdint>
#include <string>

#include "drivers/adc/load_cell_config.hpp"
#include "drivers/i2c/i2c_bus.hpp"

// ADS1115, 16-bit converter. Registers big-endian. Source: Texas Instruments SBAS444.
namespace sandhopper {

inline constexpr std::uint8_t kAds1115Conversion = 0;
inline constexpr std::uint8_t kAds1115Config = 1;
inline constexpr std::uint8_t kAds1115LowThreshold = 2;
inline constexpr std::uint8_t kAds1115HighThreshold = 3;

// Continuous conversion of the configured input, ready pin after each one.
std::uint16_t ads1115_config_word(const LoadCellConfig& config) noexcept;

double ads1115_full_scale_V(AdcRange range) noexcept;
double ads1115_period_s(AdcRate rate) noexcept;

// Force = sign . scale . (counts . full scale / 32768 - zero).
double load_cell_force_N(const LoadCellConfig& config, std::int16_t counts) noexcept;

class Ads1115 {
 public:
  Ads1115(std::string role, I2cBus& bus, const LoadCellConfig& config);

  // Sets the converter up, reads the set-up back and leaves the pointer at the conversion register. Throws
  // DeviceError.
  void start();

  // Reads the newest conversion (two bytes); the pointer stays at the conversion register. False if it
  // failed.
  bool read(std::int16_t& counts) noexcept;

 private:
  void write_register(std::uint8_t reg, std::uint16_t value);
  std::uint16_t read_register(std::uint8_t reg);
  [[noreturn]] void fail(const char* action) const;

  std::string role_;
  I2cBus& bus_;
  LoadCellConfig config_;
  std::uint8_t address_;
};

}  // namespace sandhopper
