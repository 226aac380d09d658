#include "drivers/can/mit_protocol.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sandhopper {
namespace {

using ::testing::ElementsAre;

constexpr MitRanges kAk80_9{};  // AK80-9: P 12.5, V 50, Kp 500, Kd 5, T 18

TEST(MitProtocol, CommandsPackToTheTruncatedVectors) {
  EXPECT_THAT(pack_mit_command(kAk80_9, {}), ElementsAre(0x7F, 0xFF, 0x7F, 0xF0, 0x00, 0x00, 0x07, 0xFF));
  EXPECT_THAT(pack_mit_command(kAk80_9, {12.5, 50, 500, 5, 18}), ::testing::Each(0xFF));
  EXPECT_THAT(pack_mit_command(kAk80_9, {-12.5, -50, 0, 0, -18}), ::testing::Each(0x00));
  EXPECT_THAT(pack_mit_command(kAk80_9, {1, 2, 10, 1, 0.5}),
              ElementsAre(0x8A, 0x3C, 0x85, 0x10, 0x51, 0x33, 0x38, 0x38));
  EXPECT_THAT(pack_mit_command(kAk80_9, {-3.14, 0, 50, 2, -1.5}),
              ElementsAre(0x5F, 0xD8, 0x7F, 0xF1, 0x99, 0x66, 0x67, 0x54));
}

TEST(MitProtocol, ValuesBeyondTheRangeAreClampedNotWrapped) {
  EXPECT_EQ(pack_mit_command(kAk80_9, {1e9, 1e9, 1e9, 1e9, 1e9}),
            pack_mit_command(kAk80_9, {12.5, 50, 500, 5, 18}));
  EXPECT_EQ(pack_mit_command(kAk80_9, {-1e9, -1e9, -1e9, -1e9, -1e9}),
            pack_mit_command(kAk80_9, {-12.5, -50, 0, 0, -18}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(pack_mit_command(kAk80_9, {nan, nan, nan, nan, nan}), ::testing::Each(0x00));
}

TEST(MitProtocol, NoCommandSpellsASpecialFrame) {
  const double count = 36.0 / 4095.0;
  for (const int below : {1, 2, 3}) {
    const auto payload = pack_mit_command(kAk80_9, {12.5, 50, 500, 5, 18 - (below - 0.5) * count});
    EXPECT_FALSE(is_special(payload)) << below;
    EXPECT_EQ(payload[4], 0xFE);
  }
}

TEST(MitProtocol, ReplyUnpacksToTheVector) {
  const std::array<std::uint8_t, 8> bytes{0x01, 0x8A, 0x3D, 0x7D, 0x78, 0x8E, 0x46, 0x00};
  const auto reply = unpack_mit_reply(kAk80_9, ReplyFlavour::temperature_offset_40, bytes);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->drive_id, 1);
  EXPECT_NEAR(reply->position_rad, 1.000038, 0.5e-6);
  EXPECT_NEAR(reply->velocity_radps, -0.989011, 0.5e-6);
  EXPECT_NEAR(reply->torque_Nm, 1.252747, 0.5e-6);
  EXPECT_EQ(reply->temperature_C, 30.0);
  EXPECT_EQ(reply->error_code, 0);
}

TEST(MitProtocol, ReplyFieldsDependOnLengthAndFlavour) {
  const std::array<std::uint8_t, 8> bytes{0x01, 0x8A, 0x3D, 0x7D, 0x78, 0x8E, 0x99, 0x04};
  const auto unpack = [&](std::size_t length, ReplyFlavour flavour) {
    return unpack_mit_reply(kAk80_9, flavour, std::span(bytes).first(length));
  };
  const auto six = unpack(6, ReplyFlavour::temperature);
  ASSERT_TRUE(six);
  EXPECT_TRUE(std::isnan(six->temperature_C));
  EXPECT_TRUE(std::isnan(six->bus_voltage_V));
  EXPECT_EQ(six->error_code, 0);
  const auto seven = unpack(7, ReplyFlavour::bus_voltage);
  ASSERT_TRUE(seven);
  EXPECT_DOUBLE_EQ(seven->bus_voltage_V, 24.0);
  EXPECT_TRUE(std::isnan(seven->temperature_C));
  const auto eight = unpack(8, ReplyFlavour::temperature);
  ASSERT_TRUE(eight);
  EXPECT_EQ(eight->temperature_C, 153.0);
  EXPECT_EQ(eight->error_code, 4);
  EXPECT_TRUE(std::isnan(unpack(8, ReplyFlavour::plain)->temperature_C));
  EXPECT_FALSE(unpack(5, ReplyFlavour::plain));
  EXPECT_FALSE(unpack(0, ReplyFlavour::plain));
}

TEST(MitProtocol, EveryReplyCountComesBackUnchanged) {
  for (std::uint32_t count = 0; count <= 0xFFFF; ++count) {
    const std::uint32_t twelve = count & 0xFFFU;
    const MitPayload bytes{7,
                           static_cast<std::uint8_t>(count >> 8U),
                           static_cast<std::uint8_t>(count & 0xFFU),
                           static_cast<std::uint8_t>(twelve >> 4U),
                           static_cast<std::uint8_t>(((twelve & 0xFU) << 4U) | (twelve >> 8U)),
                           static_cast<std::uint8_t>(twelve & 0xFFU),
                           90,
                           3};
    const auto reply = unpack_mit_reply(kAk80_9, ReplyFlavour::temperature_offset_40, bytes);
    ASSERT_TRUE(reply);
    ASSERT_EQ(pack_mit_reply(kAk80_9, ReplyFlavour::temperature_offset_40, *reply), bytes) << count;
  }
}

TEST(MitProtocol, CommandsSurviveTheDrivesSideWithinOneCount) {
  const MitCommand sent{1.234, -5.6, 78.9, 1.23, -4.56};
  const auto got = unpack_mit_command(kAk80_9, pack_mit_command(kAk80_9, sent));
  EXPECT_NEAR(got.position_rad, sent.position_rad, 25.0 / 65535);
  EXPECT_NEAR(got.velocity_radps, sent.velocity_radps, 100.0 / 4095);
  EXPECT_NEAR(got.kp_Nm_per_rad, sent.kp_Nm_per_rad, 500.0 / 4095);
  EXPECT_NEAR(got.kd_Nm_s_per_rad, sent.kd_Nm_s_per_rad, 5.0 / 4095);
  EXPECT_NEAR(got.torque_Nm, sent.torque_Nm, 36.0 / 4095);
}

}  // namespace
}  // namespace sandhopper
