#include "drivers/tof/sci_protocol.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sandhopper {
namespace {

using Bytes = std::vector<std::uint8_t>;
using ::testing::ElementsAre;

TEST(SciProtocol, CommandsEncodeToTheVectors) {
  EXPECT_THAT(sci_encode(SciCommand::output_mode, Bytes{kSciOutputMode1d}),
              ElementsAre(0x02, 0x41, 0x07, 0xF5, 0x03));
  EXPECT_THAT(sci_encode(SciCommand::frame_time, Bytes{0x00, 0x03, 0x0D, 0x40}),
              ElementsAre(0x02, 0x43, 0x00, 0x1B, 0xFC, 0x0D, 0x40, 0x85, 0x03));
  EXPECT_THAT(sci_encode(SciCommand::start), ElementsAre(0x02, 0x11, 0xD0, 0x03));
  EXPECT_THAT(sci_encode(SciCommand::stop), ElementsAre(0x02, 0x12, 0xF7, 0x03));
  EXPECT_THAT(sci_encode(SciCommand::frame_time, Bytes{0x00, 0x00, 0x03, 0xE8}),
              ElementsAre(0x02, 0x43, 0x00, 0x00, 0x1B, 0xFC, 0xE8, 0xAF, 0x03));
}

struct Seen {
  SciCommand command;
  std::optional<std::uint8_t> address;
  Bytes payload;
};

std::vector<Seen> parse(SciParser& parser, const Bytes& bytes) {
  std::vector<Seen> out;
  for (const auto byte : bytes)
    if (const auto frame = parser.feed(byte))
      out.push_back({frame->command, frame->address, {frame->payload.begin(), frame->payload.end()}});
  return out;
}

TEST(SciProtocol, WhatIsEncodedIsParsed) {
  Bytes every_byte;
  for (int i = 0; i < 256; ++i) every_byte.push_back(static_cast<std::uint8_t>(i));
  SciParser parser;
  const auto seen = parse(parser, sci_encode(SciCommand::frame_time, every_byte, std::uint8_t{0x1B}));
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_EQ(seen[0].command, SciCommand::frame_time);
  EXPECT_EQ(seen[0].address, 0x1B);
  EXPECT_EQ(seen[0].payload, every_byte);
  EXPECT_EQ(parser.broken_frames(), 0U);
}

SciMeasurement measurement() {
  SciMeasurement m;
  m.device_time_ns = 3'000'048'000;
  m.range_m = 0.25;
  m.amplitude = 130.5;
  m.quality = 90;
  return m;
}

TEST(SciProtocol, MeasurementHasTwentyBytesOfCommandAddressAndPayload) {
  SciParser parser;
  const auto bytes = encode_measurement_1d(measurement());
  EXPECT_EQ(bytes[1], 0xB6);
  std::optional<SciMeasurement> got;
  for (const auto byte : bytes)
    if (const auto frame = parser.feed(byte)) {
      EXPECT_EQ(frame->payload.size(), 18U);
      got = decode_measurement_1d(*frame);
    }
  ASSERT_TRUE(got);
  EXPECT_EQ(got->status, 0);
  EXPECT_EQ(got->device_time_ns, 3'000'048'000);
  EXPECT_DOUBLE_EQ(got->range_m, 0.25);
  EXPECT_DOUBLE_EQ(got->amplitude, 130.5);
  EXPECT_EQ(got->quality, 90);
}

TEST(SciProtocol, NegativeRangeAndStatusKeepTheirSign) {
  auto m = measurement();
  m.range_m = -0.5;
  m.status = -110;
  SciParser parser;
  for (const auto byte : encode_measurement_1d(m))
    if (const auto frame = parser.feed(byte)) {
      EXPECT_DOUBLE_EQ(decode_measurement_1d(*frame)->range_m, -0.5);
      EXPECT_EQ(decode_measurement_1d(*frame)->status, -110);
    }
}

TEST(SciProtocol, AnyDamagedFrameCostsItselfOnly) {
  const auto good = encode_measurement_1d(measurement());
  for (std::size_t at = 0; at < good.size(); ++at) {
    for (const int kind : {0, 1, 2}) {
      Bytes damaged = good;
      if (kind == 0) damaged[at] ^= 0x40U;
      if (kind == 1) damaged.erase(damaged.begin() + static_cast<std::ptrdiff_t>(at));
      if (kind == 2) damaged.resize(at);
      SciParser parser;
      auto stream = good;
      stream.insert(stream.end(), damaged.begin(), damaged.end());
      for (int i = 0; i < 3; ++i) stream.insert(stream.end(), good.begin(), good.end());
      int decoded = 0;
      for (const auto& seen : parse(parser, stream)) {
        const SciFrame frame{seen.command, seen.address, seen.payload};
        const auto m = decode_measurement_1d(frame);
        if (!m) continue;
        ++decoded;
        EXPECT_DOUBLE_EQ(m->range_m, 0.25) << "byte " << at << ", damage " << kind;
      }
      EXPECT_EQ(decoded, 4) << "byte " << at << ", damage " << kind;
    }
  }
}

TEST(SciProtocol, NoiseWithoutEndDoesNotOverflow) {
  SciParser parser;
  parse(parser, Bytes(2000, 0x55));
  Bytes endless(2000, 0x55);
  endless[0] = kSciStart;
  EXPECT_TRUE(parse(parser, endless).empty());
  EXPECT_EQ(parser.broken_frames(), 1U);
  EXPECT_EQ(parse(parser, sci_encode(SciCommand::ping)).size(), 1U);
}

TEST(SciProtocol, AnswersNameTheirCommand) {
  SciParser parser;
  std::vector<SciAnswer> answers;
  auto stream = sci_encode(SciCommand::acknowledge, Bytes{0x11});
  const auto refusal = sci_encode(SciCommand::refuse, Bytes{0x43, 0xFF, 0xFE});
  stream.insert(stream.end(), refusal.begin(), refusal.end());
  for (const auto byte : stream)
    if (const auto frame = parser.feed(byte))
      if (const auto answer = decode_answer(*frame)) answers.push_back(*answer);
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(answers[0].command, SciCommand::start);
  EXPECT_TRUE(answers[0].accepted);
  EXPECT_EQ(answers[1].command, SciCommand::frame_time);
  EXPECT_FALSE(answers[1].accepted);
  EXPECT_EQ(answers[1].reason, -2);
}

}  // namespace
}  // namespace sandhopper
