#include "drivers/adc/ads1115.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "drivers/device_error.hpp"

namespace sandhopper {
namespace {

// Emulates the chip: four big-endian registers behind a pointer that keeps its value.
class FakeConverter : public I2cBus {
 public:
  bool write(std::uint8_t address, std::span<const std::uint8_t> bytes) noexcept override {
    if (address != 0x48) return false;
    pointer = bytes[0];
    if (bytes.size() == 3 && !stuck)
      registers[pointer] = static_cast<std::uint16_t>((bytes[1] << 8) | bytes[2]);
    return true;
  }
  bool read(std::uint8_t address, std::span<std::uint8_t> bytes) noexcept override {
    if (address != 0x48) return false;
    bytes[0] = static_cast<std::uint8_t>(registers[pointer] >> 8U);
    bytes[1] = static_cast<std::uint8_t>(registers[pointer] & 0xFFU);
    if (pointer == kAds1115Config) bytes[0] |= 0x80U;  // conversion finished
    return true;
  }

  std::array<std::uint16_t, 4> registers{0, 0x8583, 0x8000, 0x7FFF};
  std::uint8_t pointer = 0xFF;
  bool stuck = false;
};

TEST(Ads1115, ConfigWordsAreTheDatasheets) {
  LoadCellConfig config;
  EXPECT_EQ(ads1115_config_word(config), 0x02E0);  // A0-A1, 4.096 V, continuous, 860 SPS, ready after one
  config.input = AdcInput::a0;
  EXPECT_EQ(ads1115_config_word(config), 0x42E0);
  config.input = AdcInput::a2_a3;
  config.range = AdcRange::v0_256;
  config.rate = AdcRate::sps128;
  EXPECT_EQ(ads1115_config_word(config), 0x3A80);
}

TEST(Ads1115, StartSetsUpReadySignalAndLeavesThePointerAtTheConversion) {
  FakeConverter chip;
  Ads1115 converter("load_cell", chip, LoadCellConfig{});
  converter.start();
  EXPECT_EQ(chip.registers[kAds1115Config], 0x02E0);
  EXPECT_EQ(chip.registers[kAds1115LowThreshold], 0x0000);
  EXPECT_EQ(chip.registers[kAds1115HighThreshold], 0x8000);
  EXPECT_EQ(chip.pointer, kAds1115Conversion);
  chip.registers[kAds1115Conversion] = 0xFFFE;
  std::int16_t counts = 0;
  EXPECT_TRUE(converter.read(counts));
  EXPECT_EQ(counts, -2);
}

TEST(Ads1115, ForceFollowsScaleZeroAndSign) {
  LoadCellConfig config;
  config.scale_N_per_V = 50.0;
  config.zero_V = 0.25;
  EXPECT_DOUBLE_EQ(load_cell_force_N(config, 8000), 50.0 * (1.0 - 0.25));  // 125 uV per count
  config.sign = -1;
  EXPECT_DOUBLE_EQ(load_cell_force_N(config, -8000), 50.0 * 1.25);
}

TEST(Ads1115, StartErrorsSayWhatToCheck) {
  const auto error_of = [](FakeConverter& chip, int address) -> std::string {
    LoadCellConfig config;
    config.address = address;
    try {
      Ads1115("load_cell", chip, config).start();
    } catch (const DeviceError& error) {
      return error.what();
    }
    return "";
  };
  FakeConverter chip;
  EXPECT_THAT(error_of(chip, 0x49), ::testing::HasSubstr("ADDR"));
  chip.stuck = true;
  EXPECT_THAT(error_of(chip, 0x48), ::testing::HasSubstr("does not read back"));
}

}  // namespace
}  // namespace sandhopper
