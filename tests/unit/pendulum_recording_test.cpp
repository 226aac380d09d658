#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "drivers/can/cubemars.hpp"

// Replies of a real AK80-6, recorded by another laboratory as the values its drive put on the bus: the
// payloads are rebuilt from the reply grid and decoded.
namespace sandhopper {
namespace {

constexpr double kPrintedDigits = 0.5e-8;

std::filesystem::path recordings() {
  const char* elsewhere = std::getenv("SANDHOPPER_SHARED_DATA");
  const std::filesystem::path shared =
      elsewhere != nullptr ? elsewhere : std::filesystem::path(SANDHOPPER_SOURCE_DIR) / "../shared/data";
  return shared / "pendulum_ak80_6";
}

struct Grid {
  double range;
  double counts;  // 2^bits - 1

  int count(double value) const {
    return static_cast<int>(std::lround((value + range) * counts / (2.0 * range)));
  }
  double value(int count) const { return -range + count * (2.0 * range) / counts; }
};

constexpr Grid kPosition{95.5, 65535.0};
constexpr Grid kVelocity{45.0, 4095.0};
constexpr Grid kTorque{18.0, 4095.0};

CanConfig ak80_6() {
  CanConfig config;
  config.motor_count = 1;
  auto& motor = config.motor[0];
  motor.can_id = 1;
  motor.reply = ReplyFlavour::plain;
  motor.position_range_rad = kPosition.range;
  motor.velocity_range_radps = kVelocity.range;
  motor.torque_range_Nm = kTorque.range;
  motor.torque_constant_Nm_per_A = motor.drive_torque_constant_Nm_per_A = 1.0;
  return config;
}

struct Counts {
  int position, velocity, torque;
};

can_frame reply_frame(const Counts& c) {
  can_frame frame{};
  frame.can_dlc = 6;
  const std::array<int, 6> bytes{1,
                                 c.position >> 8,
                                 c.position & 0xFF,
                                 c.velocity >> 4,
                                 ((c.velocity & 0xF) << 4) | (c.torque >> 8),
                                 c.torque & 0xFF};
  for (std::size_t i = 0; i < bytes.size(); ++i) frame.data[i] = static_cast<std::uint8_t>(bytes[i]);
  return frame;
}

class PendulumRecording : public ::testing::TestWithParam<const char*> {};

TEST_P(PendulumRecording, EveryRowDecodesToTheBitExactGridValue) {
  const auto path = recordings() / (std::string(GetParam()) + ".csv");
  std::ifstream file(path);
  if (!file) {
    std::printf("*** SKIPPED: %s is not there; set SANDHOPPER_SHARED_DATA to the recordings ***\n",
                path.c_str());
    GTEST_SKIP() << path << " is not there";
  }
  std::string line;
  ASSERT_TRUE(std::getline(file, line));
  ASSERT_EQ(line, "time,position,velocity,torque");
  CanTraceDecoder decoder(ak80_6());
  int rows = 0;
  int exact = 0;
  int on_grid = 0;
  while (std::getline(file, line)) {
    double time_s{}, p{}, v{}, t{};
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &time_s, &p, &v, &t), 4) << line;
    ++rows;
    const Counts c{kPosition.count(p), kVelocity.count(v), kTorque.count(t)};
    const auto time_ns = static_cast<std::int64_t>(std::llround(time_s * 1e9));
    const auto reading = decoder.decode(reply_frame(c), time_ns);
    ASSERT_TRUE(reading) << "row " << rows;
    const auto& s = reading->sample;
    // The same double as the grid's formula gives, and the one whose eight printed decimals are the file's.
    exact += s.position_rad == kPosition.value(c.position) &&
             s.velocity_radps == kVelocity.value(c.velocity) && s.current_A == kTorque.value(c.torque) &&
             s.time_ns == time_ns;
    on_grid += std::abs(s.position_rad - p) <= kPrintedDigits * 1.001 &&
               std::abs(s.velocity_radps - v) <= kPrintedDigits * 1.001 &&
               std::abs(s.current_A - t) <= kPrintedDigits * 1.001;
  }
  std::printf("%s: %d rows, %d bit-exact, %d equal to the printed digits, %u replies decoded\n", GetParam(),
              rows, exact, on_grid, decoder.bus().counters(Side::left).replies);
  EXPECT_GT(rows, 1000);
  EXPECT_EQ(exact, rows);
  EXPECT_EQ(on_grid, rows);
  EXPECT_EQ(decoder.bus().counters(Side::left).replies, static_cast<std::uint32_t>(rows));
}

INSTANTIATE_TEST_SUITE_P(Ak80_6, PendulumRecording,
                         ::testing::Values("gravity_compensation", "ddp", "system_identification",
                                           "energy_shaping"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace sandhopper
