#include "drivers/tof/afbr_s50.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <termios.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <mutex>
#include <thread>

#include "drivers/clock.hpp"
#include "drivers/device_error.hpp"

namespace sandhopper {
namespace {

// A companion controller on a pseudo-terminal. It acknowledges every command, refuses one if asked to, and
// sends a measurement after "start".
class FakeCompanion {
 public:
  FakeCompanion() : master_(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    if (::grantpt(master_.get()) != 0 || ::unlockpt(master_.get()) != 0) throw std::runtime_error("no pty");
    path = ::ptsname(master_.get());
    // Held open, so that the line stays up between two openings by the driver.
    slave_ = UniqueFd(::open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
    termios raw{};
    ::tcgetattr(slave_.get(), &raw);
    ::cfmakeraw(&raw);
    ::tcsetattr(slave_.get(), TCSANOW, &raw);
  }
  ~FakeCompanion() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }

  void run() {
    thread_ = std::thread([this] {
      while (!stop_) serve();
    });
  }

  void send(const std::vector<std::uint8_t>& bytes) {
    ASSERT_EQ(::write(master_.get(), bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }

  std::string path;
  std::optional<SciCommand> refused;

  std::vector<std::vector<std::uint8_t>> commands() {
    const std::scoped_lock lock(mutex_);
    return commands_;
  }

 private:
  void serve() {
    pollfd p{master_.get(), POLLIN, 0};
    if (::poll(&p, 1, 10) <= 0) return;
    std::array<std::uint8_t, 64> bytes{};
    const auto count = ::read(master_.get(), bytes.data(), bytes.size());
    for (ssize_t i = 0; i < count; ++i)
      if (const auto frame = parser_.feed(bytes[static_cast<std::size_t>(i)])) answer(*frame);
  }

  void answer(const SciFrame& frame) {
    const auto code = static_cast<std::uint8_t>(frame.command);
    {
      const std::scoped_lock lock(mutex_);
      commands_.emplace_back(1, code);
      commands_.back().insert(commands_.back().end(), frame.payload.begin(), frame.payload.end());
    }
    send(encode_measurement_1d({}));  // measurements of an earlier session
    if (frame.command == refused)
      send(sci_encode(SciCommand::refuse, std::vector<std::uint8_t>{code, 0xFF, 0xFE}));
    else
      send(sci_encode(SciCommand::acknowledge, std::vector<std::uint8_t>{code}));
  }

  UniqueFd master_;
  UniqueFd slave_;
  SciParser parser_;
  std::mutex mutex_;
  std::vector<std::vector<std::uint8_t>> commands_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

TEST(AfbrS50, StartUpStopsSetsUpAndStarts) {
  FakeCompanion companion;
  companion.run();
  TofConfig config;
  config.device = companion.path;
  const AfbrS50 sensor(config);
  using ::testing::ElementsAre;
  EXPECT_THAT(companion.commands(),
              ElementsAre(ElementsAre(0x12), ElementsAre(0x01), ElementsAre(0x41, 7), ElementsAre(0x44, 0),
                          ElementsAre(0x45, 0), ElementsAre(0x43, 0, 0, 0x07, 0xD0), ElementsAre(0x11)));
}

TEST(AfbrS50, MeasurementsBecomeHeightsStampedWithTheirArrivalLessLatency) {
  FakeCompanion companion;
  companion.run();
  TofConfig config;
  config.device = companion.path;
  config.mount_offset_m = 0.03;
  config.latency_s = 0.002;
  AfbrS50 sensor(config);
  TofSample sample;
  while (sensor.acquire(sample)) {  // reads the measurements sent during the start
  }
  SciMeasurement m;
  m.range_m = 0.5;
  m.amplitude = 100.0;
  m.quality = 77;
  const auto before = monotonic_ns();
  companion.send(encode_measurement_1d(m));
  while (!sensor.acquire(sample)) {
  }
  EXPECT_DOUBLE_EQ(sample.height_m, 0.53);
  EXPECT_EQ(sample.quality, 77);
  EXPECT_TRUE(sample.fresh);
  EXPECT_GE(sample.time_ns, before - 2'000'000);
  EXPECT_LE(sample.time_ns, monotonic_ns() - 2'000'000);
}

TEST(AfbrS50, ARefusedCommandNamesDeviceAndCode) {
  FakeCompanion companion;
  companion.refused = SciCommand::frame_time;
  companion.run();
  TofConfig config;
  config.device = companion.path;
  try {
    const AfbrS50 sensor(config);
    FAIL();
  } catch (const DeviceError& error) {
    EXPECT_THAT(error.what(), ::testing::AllOf(::testing::HasSubstr(companion.path),
                                               ::testing::HasSubstr("0x43 refused with code -2"),
                                               ::testing::HasSubstr("frame_time_s")));
  }
}

TEST(AfbrS50, AMissingDeviceNamesPathCauseAndCure) {
  TofConfig config;
  config.device = "/dev/no_such_line";
  try {
    const AfbrS50 sensor(config);
    FAIL();
  } catch (const DeviceError& error) {
    EXPECT_THAT(error.what(), ::testing::AllOf(::testing::HasSubstr("/dev/no_such_line"),
                                               ::testing::HasSubstr("No such file or directory"),
                                               ::testing::HasSubstr("dialout")));
  }
}

TEST(TofSample, WarningsErrorsAndImpossibleRangesAreNoMeasurement) {
  SciMeasurement m;
  m.range_m = 0.4;
  EXPECT_DOUBLE_EQ(to_sample(m, TofConfig{}, 5).height_m, 0.4);
  for (const int status : {1, 108, -1, -110}) {
    auto bad = m;
    bad.status = static_cast<std::int16_t>(status);
    const auto sample = to_sample(bad, TofConfig{}, 5);
    EXPECT_TRUE(std::isnan(sample.height_m)) << status;
    EXPECT_EQ(sample.status, status);
    EXPECT_TRUE(sample.fresh);
  }
  for (const int quality : {0, 2, 100}) {
    m.quality = static_cast<std::uint8_t>(quality);
    EXPECT_DOUBLE_EQ(to_sample(m, TofConfig{}, 5).height_m, 0.4) << "quality " << quality;
  }
  m.quality = 1;  // quality flag of the sensor
  EXPECT_TRUE(std::isnan(to_sample(m, TofConfig{}, 5).height_m));
  m.quality = 100;
  for (const double range : {-0.1, 0.0, 5.0}) {
    m.range_m = range;
    EXPECT_TRUE(std::isnan(to_sample(m, TofConfig{}, 5).height_m)) << range;
  }
}

TEST(CompanionClock, FollowsTheShortestWayAndASlowClock) {
  CompanionClock clock;
  constexpr std::int64_t kMs = 1'000'000;
  constexpr std::int64_t kOffset = 777'000'000;
  // The companion's clock is 100 ppm slow and its frames are 1 to 3 ms late. After a second the error is
  // within the least delay.
  for (int i = 0; i < 5000; ++i) {
    const std::int64_t truth = 2 * kMs * i;
    const std::int64_t device = truth - truth / 10000;
    const auto mapped = clock.map(device, truth + kOffset + kMs + (i * 37 % 20) * kMs / 10);
    if (i <= 500) continue;
    ASSERT_NEAR(static_cast<double>(mapped - kOffset - truth), 1.0 * kMs, 0.1 * kMs) << i;
  }
  // A restart of the companion starts the mapping anew.
  EXPECT_EQ(clock.map(0, 20'000 * kMs), 20'000 * kMs);
}

}  // namespace
}  // namespace sandhopper
