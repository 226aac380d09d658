#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "firmware/log/cdr.hpp"
#include "firmware/log/schema_text.hpp"
#include "firmware/records.hpp"
#include "firmware/sensor_frame.hpp"

namespace sandhopper {
namespace {

enum class Mode : std::int16_t { slow, fast };

struct Inner {
  std::uint8_t small = 0;
  std::int16_t medium = 0;
  bool flag = false;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("small", self.small);
    visit("medium", self.medium);
    visit("flag", self.flag);
  }
};

struct Mixed {
  bool first = false;
  double wide = 0.0;
  std::array<Inner, 2> inner{};
  float single = 0.0F;
  std::int8_t tiny = 0;
  std::uint64_t large = 0;
  Mode mode = Mode::slow;
  std::array<std::array<std::uint16_t, 2>, 2> grid{};
  double current_A = 0.0;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("first", self.first);
    visit("wide", self.wide);
    visit("inner", self.inner);
    visit("single", self.single);
    visit("tiny", self.tiny);
    visit("large", self.large);
    visit("mode", self.mode);
    visit("grid", self.grid);
    visit("current_A", self.current_A);
  }
};

}  // namespace

template <>
struct EnumNames<Mode> {
  static constexpr std::array<std::string_view, 2> value{"slow", "fast"};
};

namespace {

Mixed example() {
  Mixed mixed;
  mixed.first = true;
  mixed.wide = -1.5;
  mixed.inner = {Inner{1, -2, true}, Inner{3, 0x0405, false}};
  mixed.single = 0.25F;
  mixed.tiny = -1;
  mixed.large = 0x0102030405060708;
  mixed.mode = Mode::fast;
  mixed.grid = {{{1, 2}, {3, 4}}};
  mixed.current_A = 2.0;
  return mixed;
}

// Laid out by hand by the rule of CDR: each field at a multiple of its size, counted from the end of the
// header.
const std::vector<unsigned> kExampleBytes = {
    0,    1, 0,    0,                        // header
    1,    0, 0,    0,    0, 0, 0,    0,      // first, gap to 8
    0,    0, 0,    0,    0, 0, 0xF8, 0xBF,   // wide
    1,    0, 0xFE, 0xFF, 1, 3, 0x05, 0x04,   // inner[0] (gap before medium), inner[1]
    0,    0, 0,    0,    0, 0, 0x80, 0x3E,   // inner[1].flag, gap, single
    0xFF, 0, 0,    0,    0, 0, 0,    0,      // tiny, gap
    8,    7, 6,    5,    4, 3, 2,    1,      // large
    1,    0, 1,    0,    2, 0, 3,    0,      // mode, grid
    4,    0, 0,    0,    0, 0, 0,    0,      // grid's end, gap
    0,    0, 0,    0,    0, 0, 0,    0x40};  // current_A

TEST(Cdr, BytesAreWhereTheStandardPutsThem) {
  ASSERT_EQ(cdr::size_of<Mixed>(), kExampleBytes.size());
  std::vector<std::byte> bytes(cdr::size_of<Mixed>(), std::byte{0xEE});
  cdr::encode(example(), bytes.data());
  for (std::size_t i = 0; i < bytes.size(); ++i)
    EXPECT_EQ(std::to_integer<unsigned>(bytes[i]), kExampleBytes[i]) << "byte " << i;
}

TEST(Cdr, DecodingGivesBackEveryBitOfAFrame) {
  SensorFrame frame;
  frame.time_ns = -5;
  frame.cycle = std::numeric_limits<std::uint64_t>::max();
  frame.motor[1].position_rad = std::numeric_limits<double>::denorm_min();
  frame.motor[1].velocity_radps = -0.0;
  frame.motor[0].fresh = true;
  frame.imu_foot.gyro_radps[2] = std::numeric_limits<double>::infinity();
  frame.tof.status = -111;
  frame.emergency_stop = true;
  frame.request = Request::disarm;
  std::array<std::byte, cdr::size_of<SensorFrame>()> first{};
  std::array<std::byte, cdr::size_of<SensorFrame>()> second{};
  cdr::encode(frame, first.data());
  SensorFrame back;
  ASSERT_TRUE(cdr::decode(first, back));
  cdr::encode(back, second.data());
  EXPECT_EQ(first, second);
  EXPECT_EQ(back.time_ns, -5);
  EXPECT_EQ(back.tof.status, -111);
  EXPECT_EQ(back.request, Request::disarm);
  EXPECT_TRUE(std::signbit(back.motor[1].velocity_radps));
  EXPECT_TRUE(std::isnan(back.motor[0].temperature_C));
}

TEST(Cdr, OtherSizesAndByteOrdersAreRefused) {
  std::array<std::byte, cdr::size_of<Event>()> bytes{};
  cdr::encode(Event{}, bytes.data());
  Event event;
  EXPECT_TRUE(cdr::decode(bytes, event));
  EXPECT_FALSE(cdr::decode(std::span(bytes).first(bytes.size() - 1), event));
  bytes[1] = std::byte{0};  // big-endian
  EXPECT_FALSE(cdr::decode(bytes, event));
}

TEST(SchemaText, ListsFieldsConstantsAndNestedTypes) {
  EXPECT_EQ(schema::message_name<Mixed>(), "sandhopper_msgs/msg/Mixed");
  EXPECT_EQ(schema::text_of<Mixed>(),
            "bool first\n"
            "float64 wide\n"
            "sandhopper_msgs/Inner[2] inner\n"
            "float32 single\n"
            "int8 tiny\n"
            "uint64 large\n"
            "int16 MODE_SLOW=0\n"
            "int16 MODE_FAST=1\n"
            "int16 mode\n"
            "uint16[4] grid\n"
            "float64 current_a  # current_A\n"
            "================================================================================\n"
            "MSG: sandhopper_msgs/Inner\n"
            "uint8 small\n"
            "int16 medium\n"
            "bool flag\n");
}

TEST(SchemaText, ANestedTypeIsDefinedOnce) {
  const std::string text = schema::text_of<StrideResult>();
  const std::string head = "MSG: sandhopper_msgs/StiffnessEstimate\n";
  const auto first = text.find(head);
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(text.find(head, first + 1), std::string::npos);
}

}  // namespace
}  // namespace sandhopper
