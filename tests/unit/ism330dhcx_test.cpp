#include "drivers/imu/ism330dhcx.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "drivers/device_error.hpp"

namespace sandhopper {
namespace {

using namespace ism330dhcx;

// Emulates the chip's registers for the start: auto-increment, and reset and reboot bits that clear
// themselves.
class FakeSensor : public SpiBus {
 public:
  FakeSensor() { registers[kWhoAmI] = kWhoAmIValue; }
  bool transfer(std::span<const std::uint8_t> out, std::span<std::uint8_t> in) noexcept override {
    if (dead) return false;
    const auto first = static_cast<std::uint8_t>(out[0] & 0x7FU);
    if ((out[0] & kReadFlag) != 0 && first == kWhoAmI && (asleep || bad_identities-- > 0)) {
      in[1] = silence;
      return true;
    }
    for (std::size_t i = 1; i < out.size(); ++i) {
      const auto address = static_cast<std::uint8_t>(first + i - 1);
      if ((out[0] & kReadFlag) != 0) {
        in[i] = registers[address];
      } else if (!read_only) {
        registers[address] = out[i];
        written.push_back({address, out[i]});
        asleep = asleep && !(address == kCtrl3C && (out[i] & kSoftwareReset) != 0);
        if (address == kCtrl3C) registers[address] &= static_cast<std::uint8_t>(~(kSoftwareReset | kReboot));
      }
    }
    return true;
  }

  std::array<std::uint8_t, 256> registers{};
  std::vector<RegisterValue> written;
  bool dead = false;
  bool read_only = false;
  bool asleep = false;     // until a software reset the identity reads as `silence`
  int bad_identities = 0;  // number of reads of the identity that give `silence`
  std::uint8_t silence = 0x00;
};

TEST(Ism330dhcx, SettingsSpellTheDatasheetsCodes) {
  std::map<int, int> set;
  for (const auto& [address, value] : settings_of(ImuConfig{})) set[address] = value;
  EXPECT_EQ(set[kCtrl1Xl], 0x86);  // 1666 Hz, 16 g, LPF2 on
  EXPECT_EQ(set[kCtrl2G], 0x8C);   // 1666 Hz, 2000 dps
  EXPECT_EQ(set[kCtrl3C], 0x44);   // block data update, address increment
  EXPECT_EQ(set[kCtrl8Xl], 0x00);  // rate / 4
  EXPECT_EQ(set[kInt1Ctrl], 0x01);
  ImuConfig other;
  other.rate_Hz = 3332;
  other.accel_range_g = 8;
  other.gyro_range_dps = 4000;
  other.accel_lowpass_divisor = 45;
  other.gyro_lowpass_code = 4;
  for (const auto& [address, value] : settings_of(other)) set[address] = value;
  EXPECT_EQ(set[kCtrl1Xl], 0x9E);
  EXPECT_EQ(set[kCtrl2G], 0x91);
  EXPECT_EQ(set[kCtrl8Xl], 0x60);
  EXPECT_EQ(set[kCtrl6C], 0x04);
  other.accel_lowpass_divisor = 2;
  for (const auto& [address, value] : settings_of(other)) set[address] = value;
  EXPECT_EQ(set[kCtrl1Xl], 0x9C);
}

TEST(Ism330dhcx, SensitivitiesAreTheDatasheets) {
  EXPECT_NEAR(accel_mps2_per_count(16), 4.786e-3, 0.5e-6);
  EXPECT_NEAR(accel_mps2_per_count(2), 0.061e-3 * 9.80665, 1e-12);
  EXPECT_NEAR(gyro_radps_per_count(2000), 1.2217e-3, 0.5e-7);
  EXPECT_NEAR(gyro_radps_per_count(250), 8.75e-3 * std::numbers::pi / 180, 1e-12);
  EXPECT_NEAR(gyro_radps_per_count(4000), 140e-3 * std::numbers::pi / 180, 1e-12);
}

TEST(Ism330dhcx, BurstDecodesLittleEndianInTheChipsOrder) {
  const std::array<std::uint8_t, kBurstSize> bytes{0x07, 0x00, 0x80, 0x01, 0x01, 0x00, 0xFF, 0xFF,
                                                   0x00, 0x80, 0x34, 0x12, 0xFF, 0x7F, 0x05, 0x08};
  const auto burst = decode_burst(bytes);
  EXPECT_TRUE(burst.accel_ready());
  EXPECT_DOUBLE_EQ(burst.temperature_C, 26.5);
  EXPECT_THAT(burst.gyro, ::testing::ElementsAre(1, -1, -32768));
  EXPECT_THAT(burst.accel, ::testing::ElementsAre(0x1234, 32767, 0x0805));
  EXPECT_EQ(encode_burst(burst), bytes);
}

TEST(Ism330dhcx, MountTurnsTheSensorsAxesIntoTheRobots) {
  ImuConfig config;
  config.mount = {0, 1, 0, 0, 0, -1, -1, 0, 0};  // x = sensor y, y = -sensor z, z = -sensor x
  ASSERT_TRUE(config.is_rotation());
  Burst burst;
  burst.accel = {-2049, 100, 200};
  burst.gyro = {10, 20, 30};
  const auto sample = to_sample(burst, config);
  const double a = accel_mps2_per_count(16);
  const double g = gyro_radps_per_count(2000);
  EXPECT_THAT(sample.accel_mps2, ::testing::ElementsAre(100 * a, -200 * a, 2049 * a));
  EXPECT_THAT(sample.gyro_radps, ::testing::ElementsAre(20 * g, -30 * g, -10 * g));
  EXPECT_NEAR(sample.accel_mps2[2], 9.81, 0.005) << "one g up reads positive";
}

TEST(Ism330dhcx, AMountThatIsNoRotationIsAProblem) {
  ImuConfig config;
  config.mount = {1, 0, 0, 0, 1, 0, 0, 0, -1};  // a mirror
  std::vector<std::string> keys;
  config.check([&](std::string_view key, std::string_view) { keys.emplace_back(key); });
  EXPECT_THAT(keys, ::testing::ElementsAre("mount"));
}

TEST(Ism330dhcx, StartResetsBeforeItSetsUpAndAppliesTheTrim) {
  FakeSensor chip;
  chip.registers[kInternalFreqFine] = 0xFC;  // -4
  Ism330dhcx sensor("imu", chip, ImuConfig{});
  sensor.start();
  ASSERT_GE(chip.written.size(), 4U);
  EXPECT_EQ(chip.written[0].address, kFuncCfgAccess);
  EXPECT_EQ(chip.written[2].address, kCtrl3C);
  EXPECT_EQ(chip.written[2].value, kSoftwareReset);
  EXPECT_EQ(chip.written[3].value, kReboot);
  EXPECT_EQ(chip.written.back().address, kCtrl1Xl) << "the accelerometer starts last";
  EXPECT_DOUBLE_EQ(sensor.actual_rate_Hz(), 1666 * (1 - 0.006));
}

std::string start_error(FakeSensor& chip) {
  try {
    Ism330dhcx("imu_foot (/dev/spidev0.1)", chip, ImuConfig{}).start();
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "";
}

TEST(Ism330dhcx, StartErrorsNameDeviceCauseAndCure) {
  using ::testing::AllOf;
  using ::testing::HasSubstr;
  FakeSensor absent;
  absent.registers[kWhoAmI] = 0x00;
  EXPECT_THAT(start_error(absent),
              AllOf(HasSubstr("imu_foot"), HasSubstr("WHO_AM_I reads 0x00"), HasSubstr("power")));
  FakeSensor other;
  other.registers[kWhoAmI] = 0x33;
  EXPECT_THAT(start_error(other), HasSubstr("Another part"));
  FakeSensor dead;
  dead.dead = true;
  EXPECT_THAT(start_error(dead), HasSubstr("SPI transfer failed"));
  FakeSensor deaf;
  deaf.read_only = true;
  EXPECT_THAT(start_error(deaf), AllOf(HasSubstr("0x12"), HasSubstr("MOSI")));
}

TEST(Ism330dhcx, AChipThatAnswersNothingAtFirstIsReadAgainAndThenReset) {
  for (const std::uint8_t silence : std::initializer_list<std::uint8_t>{0x00, 0xFF}) {
    FakeSensor slow;
    slow.silence = silence;
    slow.bad_identities = 1;
    EXPECT_EQ(start_error(slow), "");
    slow.bad_identities = 8;
    EXPECT_EQ(start_error(slow), "");
    FakeSensor asleep;
    asleep.silence = silence;
    asleep.asleep = true;
    EXPECT_EQ(start_error(asleep), "");
  }
}

TEST(Ism330dhcx, AnotherPartIsNotResetBeforeItIsNamed) {
  FakeSensor other;
  other.registers[kWhoAmI] = 0x33;
  EXPECT_THAT(start_error(other), ::testing::HasSubstr("Another part"));
  EXPECT_TRUE(other.written.empty());
}

}  // namespace
}  // namespace sandhopper
