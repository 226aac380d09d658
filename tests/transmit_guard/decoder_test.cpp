#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "drivers/can/torque_cut.hpp"
#include "drivers/transmit_guard/frame_decoder.hpp"
#include "firmware/transmit_limits.hpp"
#include "tests/transmit_guard/frames.hpp"

namespace sandhopper::transmit {
namespace {

FrameDecoder decoder_of(Dialect dialect, std::uint32_t id = 1) {
  MotorLimits motor;
  motor.dialect = dialect;
  motor.can_id = id;
  motor.master_id = 0x11;
  return FrameDecoder(motor);
}

void expect_law(const Decoded& got, const LawFields& expected) {
  EXPECT_NEAR(got.position_rad, expected.position_rad, 25.0 / 65535);
  EXPECT_NEAR(got.velocity_radps, expected.velocity_radps, 100.0 / 4095);
  EXPECT_NEAR(got.kp_Nm_per_rad, expected.kp, 500.0 / 4095);
  EXPECT_NEAR(got.kd_Nm_s_per_rad, expected.kd, 5.0 / 4095);
  EXPECT_NEAR(got.torque_Nm, expected.torque_Nm, 36.0 / 4095);
}

// Test vectors from exact arithmetic, for truncated and for rounded codes.
TEST(TransmitDecoder, ReadsTheTestVectorsOfTheMitDialect) {
  const auto decoder = decoder_of(Dialect::mit);
  expect_law(decoder.command(bytes_of(1, {0x8A, 0x3C, 0x85, 0x10, 0x51, 0x33, 0x38, 0x38})),
             {1, 2, 10, 1, 0.5});
  expect_law(decoder.command(bytes_of(1, {0x8A, 0x3D, 0x85, 0x10, 0x52, 0x33, 0x38, 0x38})),
             {1, 2, 10, 1, 0.5});
  expect_law(decoder.command(bytes_of(1, {0x5F, 0xD8, 0x7F, 0xF1, 0x99, 0x66, 0x67, 0x54})),
             {-3.14, 0, 50, 2, -1.5});
  expect_law(decoder.command(bytes_of(1, {0, 0, 0, 0, 0, 0, 0, 0})), {-12.5, -50, 0, 0, -18});
  expect_law(decoder.command(bytes_of(1, {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF})),
             {12.5, 50, 500, 5, 18});
  for (const auto& zero : {bytes_of(1, {0x7F, 0xFF, 0x7F, 0xF0, 0, 0, 0x07, 0xFF}),
                           bytes_of(1, {0x80, 0, 0x80, 0, 0, 0, 0x08, 0})})
    EXPECT_EQ(decoder.command(zero).meaning, Meaning::zero);
}

// The examples of the V3 manual, decoded with +-12.5, +-50, +-65, to one count.
TEST(TransmitDecoder, ReadsTheExamplesOfTheV3Dialect) {
  MotorLimits motor;
  motor.dialect = Dialect::v3;
  motor.can_id = 0x68;
  motor.torque_range_Nm = 65.0;
  const FrameDecoder decoder(motor);
  const std::uint32_t id = CAN_EFF_FLAG | 0x868U;
  EXPECT_EQ(decoder.command_id(), id);
  const auto speed = decoder.command(bytes_of(id, {0x00, 0x06, 0x66, 0x7F, 0xFF, 0x8F, 0x57, 0xFF}));
  EXPECT_NEAR(speed.velocity_radps, 6.0, 0.05);
  EXPECT_NEAR(speed.kd_Nm_s_per_rad, 2.0, 0.002);
  EXPECT_EQ(speed.kp_Nm_per_rad, 0.0);
  EXPECT_EQ(speed.meaning, Meaning::law);
  const auto position = decoder.command(bytes_of(id, {0x01, 0x06, 0x66, 0x42, 0x8F, 0x7F, 0xF7, 0xFF}));
  EXPECT_NEAR(position.position_rad, -6.0, 0.001);
  EXPECT_NEAR(position.kp_Nm_per_rad, 2.0, 0.13);
  EXPECT_NEAR(position.torque_Nm, 0.0, 0.02);
}

// Servo mode: extended identifier (mode << 8) | id, current in mA as 32 bits.
TEST(TransmitDecoder, ReadsCurrentsOfTheServoDialect) {
  const auto decoder = decoder_of(Dialect::servo, 0x68);
  const std::uint32_t id = CAN_EFF_FLAG | 0x168U;
  EXPECT_NEAR(decoder.command(bytes_of(id, {0, 0, 0x0F, 0xA0})).torque_Nm, 4.0 * 0.0868, 1e-12);
  EXPECT_NEAR(decoder.command(bytes_of(id, {0xFF, 0xFF, 0xF0, 0x60})).torque_Nm, -4.0 * 0.0868, 1e-12);
  EXPECT_EQ(decoder.command(bytes_of(id, {0, 0, 0, 0})).meaning, Meaning::zero);
  EXPECT_EQ(decoder.command(bytes_of(id, {0, 0, 0, 1})).meaning, Meaning::current);
  EXPECT_EQ(decoder.command(bytes_of(id, {0, 0, 0})).meaning, Meaning::no_frame);
}

TEST(TransmitDecoder, TellsMotorModeFramesFromFullScaleCommands) {
  const auto decoder = decoder_of(Dialect::mit);
  EXPECT_EQ(decoder.command(enter(1)).meaning, Meaning::enter);
  EXPECT_EQ(decoder.command(leave(1)).meaning, Meaning::leave);
  EXPECT_EQ(decoder.command(set_zero(1)).meaning, Meaning::set_zero);
  EXPECT_EQ(decoder.command(special(1, 0xFB)).meaning, Meaning::law);
  EXPECT_EQ(decoder_of(Dialect::v3).command(enter(1)).meaning, Meaning::law) << "has no such frame";
}

TEST(TransmitDecoder, CallsOnlyStandingSetPointsWithoutTorqueDamping) {
  const auto decoder = decoder_of(Dialect::mit);
  EXPECT_EQ(decoder.command(mit_law(1, {.kd = 0.3})).meaning, Meaning::damping);
  EXPECT_EQ(decoder.command(mit_law(1, {.velocity_radps = 0.1, .kd = 0.3})).meaning, Meaning::law);
  EXPECT_EQ(decoder.command(mit_law(1, {.kd = 0.3, .torque_Nm = 0.02})).meaning, Meaning::law);
  EXPECT_EQ(decoder.command(mit_law(1, {.kp = 1.0, .kd = 0.3})).meaning, Meaning::law);
}

TEST(TransmitDecoder, PutsDrivesAndLinksTogetherBySignGearAndConstants) {
  MotorLimits motor;
  motor.sign = -1;
  motor.gear_ratio = 2.0;
  motor.zero_offset_rad = 0.5;
  motor.torque_constant_Nm_per_A = 0.08;
  motor.drive_torque_constant_Nm_per_A = 0.10;
  const auto d = FrameDecoder(motor).command(
      mit_law(1, {.position_rad = 1.0, .velocity_radps = 4.0, .kp = 10.0, .kd = 1.0, .torque_Nm = 2.0}));
  EXPECT_NEAR(d.position_rad, 0.5 - 1.0 / 2.0, 0.001);
  EXPECT_NEAR(d.velocity_radps, -4.0 / 2.0, 0.02);
  EXPECT_NEAR(d.kp_Nm_per_rad, 10.0 * 4.0 * 0.8, 0.5);
  EXPECT_NEAR(d.kd_Nm_s_per_rad, 1.0 * 4.0 * 0.8, 0.01);
  EXPECT_NEAR(d.torque_Nm, -2.0 * 2.0 * 0.8, 0.02);
}

TEST(TransmitDecoder, TakesRepliesFromTheDriveInItsDialectOnly) {
  const auto mit = decoder_of(Dialect::mit);
  auto reply = bytes_of(0x11, {0x01, 0x8A, 0x3D, 0x7D, 0x78, 0x8E, 0x46, 0x00});
  ASSERT_TRUE(mit.reply(reply));
  EXPECT_NEAR(mit.reply(reply)->position_rad, 1.000038, 1e-6);
  EXPECT_NEAR(mit.reply(reply)->velocity_radps, -0.989011, 1e-6);
  reply.can_dlc = 5;
  EXPECT_FALSE(mit.reply(reply)) << "too short";
  reply.can_dlc = 6;
  EXPECT_TRUE(mit.reply(reply));
  reply.can_id = 0x12;
  EXPECT_FALSE(mit.reply(reply)) << "another drive's identifier";
  reply.can_id = 0x11 | CAN_EFF_FLAG;
  EXPECT_FALSE(mit.reply(reply)) << "extended";
  EXPECT_FALSE(mit.reply(mit_reply(2))) << "another drive's first byte";

  const auto servo = decoder_of(Dialect::servo);
  const auto seen = servo.reply(status(1, -900, 21));
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->position_rad, -std::numbers::pi / 2.0, 1e-9);
  EXPECT_NEAR(seen->velocity_radps, 10.0 * 2.0 * std::numbers::pi / 60.0, 1e-9);
  EXPECT_FALSE(servo.reply(mit_reply(1)));
}

// The frames of the torque watchdog and of the guard process do not pass through the guard's port.
TEST(TransmitDecoder, FindsNoTorqueInTheFramesOfTheTorqueCut) {
  for (const auto dialect : {sandhopper::Dialect::mit, sandhopper::Dialect::servo, sandhopper::Dialect::v3}) {
    CanConfig can;
    for (auto& motor : can.motor) motor.dialect = dialect;
    const auto limits = transmit_limits(can, {});
    int known = 0;
    const auto frames = torque_cut_frames(can);
    for (const auto& frame : frames)
      for (const auto& motor : limits.motor) {
        const FrameDecoder decoder(motor);
        if (frame.can_id != decoder.command_id()) continue;
        ++known;
        EXPECT_THAT(decoder.command(frame).meaning, ::testing::AnyOf(Meaning::zero, Meaning::leave));
      }
    EXPECT_EQ(known, static_cast<int>(frames.size())) << name_of(dialect);
    EXPECT_GE(known, 2) << name_of(dialect);
  }
}

}  // namespace
}  // namespace sandhopper::transmit
