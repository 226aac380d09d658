#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "firmware/log/candump.hpp"

namespace sandhopper {
namespace {

CandumpFrame frame_of(std::uint32_t id, std::initializer_list<std::uint8_t> data) {
  CandumpFrame frame;
  frame.time_ns = 1'700'000'000'000'001'234;
  frame.id = id;
  for (const auto byte : data) frame.data[frame.length++] = byte;
  return frame;
}

TEST(Candump, LinesLookAsCandumpWritesThem) {
  auto frame = frame_of(0x00A, {0x7F, 0xFF, 0x00});
  frame.direction = CanDirection::sent;
  EXPECT_EQ(format_candump(frame, "can0"), "(1700000000.000001) can0 00A#7FFF00 T");
  EXPECT_EQ(format_candump(frame, "can0", {.decimals = 9, .direction = false}),
            "(1700000000.000001234) can0 00A#7FFF00");
  EXPECT_EQ(format_candump(frame_of(0x80000868, {1}), "can1"), "(1700000000.000001) can1 00000868#01");
  EXPECT_EQ(format_candump(frame_of(0x20000004, {0, 1}), "can1"), "(1700000000.000001) can1 20000004#0001");
  EXPECT_EQ(format_candump(frame_of(0x40000123, {}), "can1"), "(1700000000.000001) can1 123#R");
}

TEST(Candump, EveryKindOfFrameSurvivesTheRoundTrip) {
  auto remote = frame_of(0x40000123, {});
  remote.length = 8;
  auto received = frame_of(0xC0000001, {});
  received.direction = CanDirection::received;
  for (const auto& frame :
       {frame_of(0x7FF, {}), frame_of(0, {1, 2, 3, 4, 5, 6, 7, 8}), frame_of(0x9FFFFFFF, {0xAB}),
        frame_of(0x20000040, {0, 0, 0, 0, 0, 0, 0, 0}), remote, received}) {
    const std::string text = format_candump(frame, "vcan0", {.decimals = 9});
    const auto line = parse_candump(text);
    ASSERT_TRUE(line.has_value()) << text;
    EXPECT_EQ(line->interface, "vcan0");
    EXPECT_EQ(line->frame.time_ns, frame.time_ns) << text;
    EXPECT_EQ(line->frame.id, frame.id) << text;
    EXPECT_EQ(line->frame.length, frame.length) << text;
    EXPECT_EQ(line->frame.data, frame.data) << text;
    EXPECT_EQ(line->frame.direction, frame.direction) << text;
  }
}

TEST(Candump, ToleratesWhatOtherToolsWrite) {
  EXPECT_FALSE(parse_candump("").has_value());
  EXPECT_FALSE(parse_candump("# a comment").has_value());
  EXPECT_EQ(parse_candump("(5.000001) can0 123#11.22")->frame.length, 2);
  EXPECT_EQ(parse_candump("(5.000001) can0 123#1122334455667788_E")->frame.length, 8);
  EXPECT_EQ(parse_candump("(5.000001)  can0  123#00  R  more")->frame.direction, CanDirection::received);
  EXPECT_EQ(parse_candump("(5.5) can0 123#00\r")->frame.time_ns, 5'500'000'000);
  EXPECT_EQ(parse_candump("(0000000005.000001) can0 0ab#aB")->frame.data[0], 0xAB);
}

TEST(Candump, MalformedLinesSayWhatIsWrong) {
  const auto error_of = [](std::string_view line) -> std::string {
    try {
      parse_candump(line);
    } catch (const CandumpError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(error_of("(5.0) can0 123##0112233"), ::testing::HasSubstr("CAN FD"));
  EXPECT_THAT(error_of("(5.0) can0 123#112"), ::testing::HasSubstr("pairs"));
  EXPECT_THAT(error_of("(5.0) can0 123#112233445566778899"), ::testing::HasSubstr("eight"));
  EXPECT_THAT(error_of("(5.0) can0 12#00"), ::testing::HasSubstr("three digits"));
  EXPECT_THAT(error_of("(5.0) can0 FFF#00"), ::testing::HasSubstr("7FF"));
  EXPECT_THAT(error_of("(5.0) can0 12G#00"), ::testing::HasSubstr("identifier"));
  EXPECT_THAT(error_of("(5.x) can0 123#00"), ::testing::HasSubstr("time"));
  EXPECT_THAT(error_of("(5.0 can0 123#00"), ::testing::HasSubstr("')'"));
  EXPECT_THAT(error_of("(5.0) can0"), ::testing::HasSubstr("no frame"));
  EXPECT_THAT(error_of("(5.0) can0 123"), ::testing::HasSubstr("'#'"));
  EXPECT_THAT(error_of("(5.0) can0 123#R9"), ::testing::HasSubstr("remote"));
}

TEST(Candump, AFilesErrorNamesTheLine) {
  const auto file =
      std::filesystem::temp_directory_path() / ("sandhopper_" + std::to_string(::getpid()) + ".can");
  {
    CandumpWriter writer(file);
    writer.comment("3 frames lost");
    writer.write(frame_of(1, {1}), "can0");
    writer.close();
    std::ofstream(file, std::ios::app) << "(nonsense\n";
  }
  CandumpReader reader(file);
  CandumpFrame frame;
  std::string_view interface;
  EXPECT_TRUE(reader.next(frame, interface));
  EXPECT_EQ(interface, "can0");
  try {
    static_cast<void>(reader.next(frame, interface));
    ADD_FAILURE() << "accepted";
  } catch (const CandumpError& error) {
    EXPECT_THAT(error.what(), ::testing::StartsWith(file.string() + ":3: "));
  }
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace sandhopper
