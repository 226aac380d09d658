#include "drivers/can/cubemars.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "drivers/can/drive_sequence.hpp"

namespace sandhopper {
namespace {

constexpr std::int64_t kMs = 1'000'000;

can_frame frame_of(canid_t id, std::initializer_list<int> bytes) {
  can_frame frame{};
  frame.can_id = id;
  for (const int byte : bytes) frame.data[frame.can_dlc++] = static_cast<std::uint8_t>(byte);
  return frame;
}

can_frame reply_of(canid_t id, int drive) {
  return frame_of(id, {drive, 0x8A, 0x3D, 0x7D, 0x78, 0x8E, 0x46, 0x00});
}

TEST(CubeMarsCodec, LinkSideFollowsSignGearAndZero) {
  CubeMarsConfig config;
  config.sign = -1;
  config.gear_ratio = 2.0;
  config.zero_offset_rad = 0.7;
  config.torque_constant_Nm_per_A = 0.08;
  config.drive_torque_constant_Nm_per_A = 0.10;
  const CubeMarsCodec codec(config);
  MitReply reply;
  reply.position_rad = 1.0;
  reply.velocity_radps = 4.0;
  reply.torque_Nm = 2.0;
  const auto sample = codec.to_sample(reply, 123);
  EXPECT_EQ(sample.time_ns, 123);
  EXPECT_TRUE(sample.fresh);
  EXPECT_DOUBLE_EQ(sample.position_rad, 0.7 - 0.5);
  EXPECT_DOUBLE_EQ(sample.velocity_radps, -2.0);
  EXPECT_DOUBLE_EQ(sample.current_A, -20.0);

  // 1 N m at the link is 0.5 N m at the drive's output. The drive assumes a torque constant that is 25 % too
  // large and would send too little current, so it gets 25 % more torque.
  const auto command = codec.to_drive({1.2, -2.0, 8.0, 0.4, 1.0});
  EXPECT_DOUBLE_EQ(command.position_rad, -1.0);
  EXPECT_DOUBLE_EQ(command.velocity_radps, 4.0);
  EXPECT_DOUBLE_EQ(command.kp_Nm_per_rad, 8.0 / 4.0 * 1.25);
  EXPECT_DOUBLE_EQ(command.kd_Nm_s_per_rad, 0.4 / 4.0 * 1.25);
  EXPECT_DOUBLE_EQ(command.torque_Nm, -0.625);
  const auto back = codec.to_link(command);
  EXPECT_DOUBLE_EQ(back.position_rad, 1.2);
  EXPECT_DOUBLE_EQ(back.kp_Nm_per_rad, 8.0);
  EXPECT_DOUBLE_EQ(back.torque_Nm, 1.0);
}

TEST(CubeMarsCodec, ACommandThatIsNotFiniteCarriesNoTorque) {
  const CubeMarsCodec codec(CubeMarsConfig{});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto command = codec.to_drive({0.0, 0.0, 100.0, 1.0, nan});
  EXPECT_EQ(command.kp_Nm_per_rad, 0.0);
  EXPECT_EQ(command.kd_Nm_s_per_rad, 0.0);
  EXPECT_EQ(command.torque_Nm, 0.0);
}

TEST(CubeMarsCodec, PositionNearTheEndOfItsRangeIsAFault) {
  const CubeMarsCodec codec(CubeMarsConfig{});
  MitReply reply;
  reply.position_rad = -10.9;
  EXPECT_EQ(codec.to_sample(reply, 0).error_code, 0);
  reply.position_rad = -11.1;
  EXPECT_EQ(codec.to_sample(reply, 0).error_code, kErrorPositionNearRangeEnd);
  reply.error_code = 3;
  EXPECT_EQ(codec.to_sample(reply, 0).error_code, 3);
}

TEST(CubeMarsCodec, ServoFramesAreThoseOfTheManual) {
  CubeMarsConfig config;
  config.can_id = 0x68;
  config.dialect = Dialect::servo;
  config.torque_constant_Nm_per_A = 0.1;
  const CubeMarsCodec codec(config);
  const auto frame = codec.frame(DriveAction::run, {.torque_Nm = 0.4}, {});
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->can_id, 0x168U | CAN_EFF_FLAG);
  EXPECT_EQ(frame->can_dlc, 4);
  EXPECT_THAT(std::vector(frame->data, frame->data + 4), ::testing::ElementsAre(0x00, 0x00, 0x0F, 0xA0));
  const auto back = codec.frame(DriveAction::run, {.torque_Nm = -0.4}, {});
  EXPECT_THAT(std::vector(back->data, back->data + 4), ::testing::ElementsAre(0xFF, 0xFF, 0xF0, 0x60));
  const auto off = codec.frame(DriveAction::leave, {.torque_Nm = 5.0}, {});
  EXPECT_THAT(std::vector(off->data, off->data + 4), ::testing::Each(0));
}

TEST(CubeMarsCodec, V3FramesAreThoseOfTheManualToOneCount) {
  CubeMarsConfig config;
  config.can_id = 0x68;
  config.dialect = Dialect::v3;
  config.position_range_rad = 12.5;
  config.velocity_range_radps = 50.0;
  config.torque_range_Nm = 65.0;
  const CubeMarsCodec codec(config);
  const auto frame = codec.frame(DriveAction::run, {.velocity_radps = 6.0, .kd_Nm_s_per_rad = 2.0}, {});
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->can_id, 0x868U | CAN_EFF_FLAG);
  // The manual's examples differ from each other by one count in the fields of position, velocity and torque.
  constexpr std::array<int, 8> kManual{0x00, 0x06, 0x66, 0x7F, 0xFF, 0x8F, 0x57, 0xFF};
  const auto field = [](const auto& b, int from_nibble, int nibbles) {
    int value = 0;
    for (int n = from_nibble; n < from_nibble + nibbles; ++n)
      value =
          value * 16 +
          ((n % 2 == 0 ? b[static_cast<std::size_t>(n / 2)] >> 4 : b[static_cast<std::size_t>(n / 2)]) & 0xF);
    return value;
  };
  const std::vector<int> sent(frame->data, frame->data + 8);
  for (const auto& [from, count] : {std::pair{0, 3}, {3, 3}, {6, 4}, {10, 3}, {13, 3}})
    EXPECT_NEAR(field(sent, from, count), field(kManual, from, count), 1) << "field at nibble " << from;
}

TEST(CubeMarsCodec, StatusFramesAreReadInTheirUnits) {
  CubeMarsConfig config;
  config.dialect = Dialect::servo;
  config.pole_pairs = 21;
  const CubeMarsCodec codec(config);
  // 90.0 deg, 2100 electrical rpm (100 rpm of the motor), -3.00 A, 45 C, error 2.
  const auto frame = frame_of(0x2901 | CAN_EFF_FLAG, {0x03, 0x84, 0x00, 0xD2, 0xFE, 0xD4, 45, 2});
  EXPECT_EQ(codec.match(frame), CubeMarsCodec::Match::reply);
  const auto sample = codec.sample_of(frame, 7);
  EXPECT_NEAR(sample.position_rad, 1.5707963, 1e-6);
  EXPECT_NEAR(sample.velocity_radps, 100.0 * 2.0 * 3.14159265 / 60.0, 1e-6);
  EXPECT_NEAR(sample.current_A, -3.0, 1e-12);
  EXPECT_EQ(sample.temperature_C, 45.0);
  EXPECT_EQ(sample.error_code, 2);
}

TEST(CubeMarsBus, APositionThatWrapsGoesOn) {
  PositionUnwrap unwrap;
  EXPECT_DOUBLE_EQ(unwrap.unwrap(12.0, 12.5), 12.0);
  EXPECT_DOUBLE_EQ(unwrap.unwrap(-12.4, 12.5), 12.6);
  EXPECT_DOUBLE_EQ(unwrap.unwrap(12.3, 12.5), 12.3);
  EXPECT_DOUBLE_EQ(unwrap.unwrap(0.1, 12.5), 0.1) << "less than half a span is a motion";
}

TEST(BusLoad, IsThatOfTheWorstFramesAndRefusedAboveFourFifths) {
  CanConfig config;
  EXPECT_NEAR(bus_load(config), 0.540, 1e-12);
  for (auto& motor : config.motor) motor.reply = ReplyFlavour::plain;
  EXPECT_NEAR(bus_load(config), 0.500, 1e-12);
  for (auto& motor : config.motor) motor.dialect = Dialect::servo;
  EXPECT_NEAR(bus_load(config), 0.400, 1e-12);
  for (auto& motor : config.motor) motor.dialect = Dialect::v3;
  EXPECT_NEAR(bus_load(config), 0.640, 1e-12);
  std::string said;
  const auto problem = [&](std::string_view, std::string_view text) { said = text; };
  config.other_load = 0.15;
  config.check(problem);
  EXPECT_EQ(said, "");
  config.other_load = 0.17;
  config.check(problem);
  EXPECT_THAT(said, ::testing::HasSubstr("loaded to 81 %"));
}

TEST(CubeMarsBus, MotorsThatCannotBeToldApartAreRefused) {
  CanConfig config;
  config.motor[1].can_id = config.motor[0].can_id;
  EXPECT_THROW(CubeMarsBus{config}, std::invalid_argument);
}

TEST(CubeMarsBus, RepliesAreRoutedByTheirFirstByte) {
  CubeMarsBus bus{CanConfig{}};
  for (const canid_t id : {0x000U, 0x002U, 0x012U}) {
    const auto reading = bus.receive(reply_of(id, 2), kMs);
    ASSERT_TRUE(reading) << id;
    EXPECT_EQ(reading->side, Side::right);
  }
  EXPECT_EQ(bus.receive(reply_of(0x000, 1), kMs)->side, Side::left);
}

TEST(CubeMarsBus, FramesThatDoNotLookLikeTheDialectAreRejectedAndCounted) {
  CubeMarsBus bus{CanConfig{}};
  EXPECT_FALSE(bus.receive(frame_of(0x011, {1, 0, 0, 0, 0}), 0));
  EXPECT_EQ(bus.counters(Side::left).rejected, 1U);
  EXPECT_FALSE(bus.receive(reply_of(0x2901 | CAN_EFF_FLAG, 0), 0));
  EXPECT_EQ(bus.counters(Side::left).rejected, 2U);
  EXPECT_EQ(bus.counters(Side::left).foreign, 1U);
  EXPECT_FALSE(bus.receive(reply_of(0x011, 2), 0))
      << "the left motor's identifier with the right one's number";
  EXPECT_FALSE(bus.receive(reply_of(0x123, 1), 0));
  EXPECT_FALSE(bus.receive(frame_of(0, {}), 0));
  EXPECT_EQ(bus.strangers(), 3U);
  EXPECT_EQ(bus.counters(Side::left).replies, 0U);
}

TEST(CubeMarsBus, AReplyCarriesTheTimeOfTheCommandItAnswers) {
  CanConfig config;
  config.motor[0].state_delay_s = 0.00012;
  CubeMarsBus bus{config};
  bus.command_sent(Side::left, 10 * kMs);
  EXPECT_EQ(bus.receive(reply_of(0, 1), 10 * kMs + 250'000)->sample.time_ns, 10 * kMs + 120'000);
  EXPECT_EQ(bus.counters(Side::left).unsolicited, 0U);
  EXPECT_EQ(bus.receive(reply_of(0, 1), 10 * kMs + 300'000)->sample.time_ns, 10 * kMs + 300'000);
  EXPECT_EQ(bus.counters(Side::left).unsolicited, 1U);
}

TEST(CubeMarsBus, AReplyReadLateStillBelongsToItsOwnCommand) {
  CubeMarsBus bus{CanConfig{}};
  bus.command_sent(Side::left, 10 * kMs);
  bus.command_sent(Side::left, 11 * kMs);
  EXPECT_EQ(bus.counters(Side::left).missed, 1U);
  EXPECT_EQ(bus.receive(reply_of(0, 1), 10 * kMs + 250'000)->sample.time_ns, 10 * kMs);
  EXPECT_EQ(bus.counters(Side::left).missed, 0U);
  EXPECT_EQ(bus.receive(reply_of(0, 1), 11 * kMs + 250'000)->sample.time_ns, 11 * kMs);
  bus.command_sent(Side::left, 12 * kMs);
  bus.command_sent(Side::left, 13 * kMs);
  EXPECT_EQ(bus.receive(reply_of(0, 1), 13 * kMs + 250'000)->sample.time_ns, 13 * kMs);
  EXPECT_EQ(bus.counters(Side::left).missed, 1U);
}

TEST(CubeMarsBus, FiltersPassOnlyWhatMayBeAReply) {
  const auto filters = CubeMarsBus{CanConfig{}}.filters();
  const auto passes = [&](canid_t id) {
    return std::ranges::any_of(
        filters, [&](const can_filter& f) { return (id & f.can_mask) == (f.can_id & f.can_mask); });
  };
  for (const canid_t id : {0x0U, 0x1U, 0x2U, 0x11U, 0x12U, 0x2901U | CAN_EFF_FLAG})
    EXPECT_TRUE(passes(id)) << id;
  for (const canid_t id : {0x3U, 0x10U, 0x1U | CAN_EFF_FLAG, 0x1U | CAN_RTR_FLAG, 0x2903U | CAN_EFF_FLAG})
    EXPECT_FALSE(passes(id)) << id;
}

TEST(CanTraceDecoder, CommandsGiveTheirTimeToTheReplies) {
  const CanConfig config;
  CanTraceDecoder decoder(config);
  const CubeMarsCodec right(config.motor[1]);
  EXPECT_FALSE(decoder.decode(right.command_frame({}), 5 * kMs));
  const auto reading = decoder.decode(reply_of(0x12, 2), 5 * kMs + 240'000);
  ASSERT_TRUE(reading);
  EXPECT_EQ(reading->side, Side::right);
  EXPECT_EQ(reading->sample.time_ns, 5 * kMs);
}

TEST(CanTraceDecoder, ATraceOfRepliesAloneKeepsItsOwnTimes) {
  CanTraceDecoder decoder{CanConfig{}};
  for (int i = 0; i < 5; ++i) {
    const auto reading = decoder.decode(reply_of(0x01, 1), i * kMs);
    ASSERT_TRUE(reading);
    EXPECT_EQ(reading->sample.time_ns, i * kMs);
  }
  EXPECT_FALSE(decoder.decode(reply_of(0x01, 1), 6 * kMs, FrameDirection::sent));
  EXPECT_EQ(decoder.decode(reply_of(0x01, 1), 7 * kMs, FrameDirection::received)->sample.time_ns, 6 * kMs);
}

}  // namespace
}  // namespace sandhopper
