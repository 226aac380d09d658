#include "tests/pendulum_recording.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace sandhopper {
namespace {

can_frame frame_of(const pendulum::Row& row) {
  can_frame frame{};
  const auto payload = row.payload();
  frame.can_dlc = payload.size();
  std::ranges::copy(payload, frame.data);
  return frame;
}

class PendulumRecording : public ::testing::TestWithParam<const char*> {};

TEST_P(PendulumRecording, EveryRowDecodesToTheBitExactGridValue) {
  const auto path = pendulum::folder(SANDHOPPER_SOURCE_DIR) / (std::string(GetParam()) + ".csv");
  if (!std::filesystem::exists(path)) {
    std::printf("*** SKIPPED: %s is not there; set SANDHOPPER_SHARED_DATA to the recordings ***\n",
                path.c_str());
    GTEST_SKIP() << path << " is not there";
  }
  const auto rows = pendulum::read(path);
  CanTraceDecoder decoder(pendulum::drive());
  std::size_t exact = 0;
  std::size_t near = 0;
  for (const auto& row : rows) {
    const auto reading = decoder.decode(frame_of(row), row.time_ns);
    ASSERT_TRUE(reading);
    exact += row.is_exactly(reading->sample) && reading->sample.time_ns == row.time_ns;
    near += row.is_near(reading->sample);
  }
  std::printf("%s: %zu rows, %zu bit-exact, %zu equal to the printed digits, %u replies decoded\n",
              GetParam(), rows.size(), exact, near, decoder.bus().counters(Side::left).replies);
  EXPECT_GT(rows.size(), 1000U);
  EXPECT_EQ(exact, rows.size());
  EXPECT_EQ(near, rows.size());
  EXPECT_EQ(decoder.bus().counters(Side::left).replies, rows.size());
}

INSTANTIATE_TEST_SUITE_P(Ak80_6, PendulumRecording,
                         ::testing::Values("gravity_compensation", "ddp", "system_identification",
                                           "energy_shaping"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace sandhopper
