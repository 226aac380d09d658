#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "drivers/clock.hpp"
#include "drivers/device_error.hpp"
#include "firmware/instance_lock.hpp"
#include "firmware/watchdog/keepalive.hpp"
#include "firmware/watchdog/stall_detector.hpp"
#include "firmware/watchdog/torque_watchdog.hpp"

namespace sandhopper {
namespace {

using ::testing::HasSubstr;
constexpr std::int64_t kMs = 1'000'000;

void beat(Heartbeat& heart) { heart.beat(State::flight, Fault::none); }

TEST(StallDetector, CountsFromTheLookThatLastSawABeat) {
  Heartbeat heart;
  StallDetector detector;
  EXPECT_EQ(detector.see(heart, 100 * kMs), 0) << "has not begun";
  EXPECT_EQ(detector.see(heart, 900 * kMs), 0) << "has not begun";
  beat(heart);
  EXPECT_EQ(detector.see(heart, 905 * kMs), 0);
  EXPECT_EQ(detector.see(heart, 910 * kMs), 5 * kMs);
  beat(heart);
  EXPECT_EQ(detector.see(heart, 915 * kMs), 0);
  EXPECT_EQ(detector.see(heart, 935 * kMs), 20 * kMs);
  heart.end();
  EXPECT_EQ(detector.see(heart, 940 * kMs), 0);
  EXPECT_EQ(detector.see(heart, 999 * kMs), 0) << "has ended in order";
}

WatchdogConfig config_for_test() {
  WatchdogConfig config;
  config.priority = 0;
  config.device.clear();
  return config;
}

template <class Condition>
bool within_10_s(const Condition& condition) {
  const auto until_ns = monotonic_ns() + 10'000 * kMs;
  while (!condition() && monotonic_ns() < until_ns) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return condition();
}

TEST(TorqueWatchdog, TakesTheTorqueFromACycleThatStandsStillAndKeepsTakingIt) {
  Heartbeat heart;
  std::atomic<int> cuts{0};
  std::atomic<std::int64_t> first_ns{0};
  const TorqueWatchdog watchdog(config_for_test(), heart, [&] {
    if (cuts++ == 0) first_ns = monotonic_ns();
  });
  beat(heart);
  const auto last_beat_ns = monotonic_ns();
  ASSERT_TRUE(within_10_s([&] { return cuts > 3; }));
  EXPECT_GE(first_ns - last_beat_ns, 14 * kMs) << "the limit is 20 ms, and a beat is seen up to 5 ms late";
  EXPECT_TRUE(heart.tripped());
  EXPECT_EQ(watchdog.trips(), 1U) << "one standstill is one trip";
  EXPECT_GE(heart.take_trip(), 20 * kMs);
  beat(heart);
  ASSERT_TRUE(within_10_s([&] { return watchdog.trips() == 2; })) << "and the next one another";
  EXPECT_GE(watchdog.longest_stall_s(), 0.020);
}

TEST(TorqueWatchdog, LeavesACycleAloneThatHasNotBegunOrHasEnded) {
  Heartbeat heart;
  std::atomic<int> cuts{0};
  const TorqueWatchdog watchdog(config_for_test(), heart, [&] { ++cuts; });
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  heart.end();
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  EXPECT_EQ(cuts, 0);
  EXPECT_FALSE(heart.tripped());
}

// A service manager that receives sd_notify(3) messages.
class ServiceManager {
 public:
  explicit ServiceManager(const char* watchdog_us) : fd_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path_.c_str(), sizeof address.sun_path - 1);
    std::filesystem::remove(path_);
    EXPECT_EQ(::bind(fd_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ::setenv("NOTIFY_SOCKET", path_.c_str(), 1);
    ::setenv("WATCHDOG_USEC", watchdog_us, 1);
    ::setenv("WATCHDOG_PID", std::to_string(::getpid()).c_str(), 1);
  }
  ~ServiceManager() {
    for (const auto* name : {"NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"}) ::unsetenv(name);
    std::filesystem::remove(path_);
  }
  const std::string& heard() {
    char text[512];
    for (ssize_t got = 0; (got = ::recv(fd_.get(), text, sizeof text, 0)) > 0;)
      heard_ += std::string(text, static_cast<std::size_t>(got)) + ";";
    return heard_;
  }
  int count(const std::string& text) {
    int n = 0;
    heard();
    for (auto at = heard_.find(text); at != std::string::npos; at = heard_.find(text, at + 1)) ++n;
    return n;
  }

 private:
  std::string path_ =
      (std::filesystem::temp_directory_path() / ("sh_notify." + std::to_string(::getpid()))).string();
  UniqueFd fd_;
  std::string heard_;
};

TEST(Keepalive, SpeaksForACycleThatBeatsAndOnlyForThat) {
  ServiceManager manager("40000");
  Heartbeat heart;
  {
    const Keepalive keepalive(config_for_test(), heart);
    std::this_thread::sleep_for(std::chrono::milliseconds(60));
    EXPECT_EQ(manager.heard(), "") << "not ready before the first beat";
    ASSERT_TRUE(within_10_s([&] {
      beat(heart);
      return manager.count("WATCHDOG=1") >= 3;
    }));
    EXPECT_EQ(manager.count("READY=1"), 1);
    EXPECT_EQ(manager.count("STATUS=flight"), 1) << "said when it changes";
    std::this_thread::sleep_for(std::chrono::milliseconds(60));
    const int spoken = manager.count("WATCHDOG=1");
    std::this_thread::sleep_for(std::chrono::milliseconds(120));
    EXPECT_EQ(manager.count("WATCHDOG=1"), spoken) << "a cycle that stands still is not spoken for";
    heart.beat(State::fault, Fault::cycle_gap);
    EXPECT_TRUE(within_10_s([&] { return manager.count("STATUS=fault, fault cycle_gap") == 1; }));
    EXPECT_EQ(manager.count("STOPPING=1"), 0);
  }
  EXPECT_EQ(manager.count("STOPPING=1"), 1);
}

std::string contents(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

// An ordinary file replaces the device and records what is written to it.
TEST(Keepalive, FeedsTheKernelsWatchdogAndDisarmsItAtAnOrderlyEnd) {
  const auto device = std::filesystem::temp_directory_path() / ("sh_watchdog." + std::to_string(::getpid()));
  std::ofstream(device).close();
  auto config = config_for_test();
  config.device = device;
  Heartbeat heart;
  {
    const Keepalive keepalive(config, heart);
    EXPECT_THAT(keepalive.warning(), HasSubstr("takes no time-out"));
    ASSERT_TRUE(within_10_s([&] {
      beat(heart);
      return contents(device).size() >= 2;
    }));
    EXPECT_THAT(contents(device), ::testing::Not(HasSubstr("V")));
  }
  EXPECT_EQ(contents(device).back(), 'V');
  std::filesystem::remove(device);
}

TEST(Keepalive, AMissingKernelWatchdogIsSaidAndNoError) {
  auto config = config_for_test();
  config.device = "/dev/no_watchdog_here";
  const Heartbeat heart;
  const Keepalive keepalive(config, heart);
  EXPECT_THAT(keepalive.warning(), HasSubstr("no kernel watchdog (/dev/no_watchdog_here: No such file"));
}

TEST(InstanceLock, ASecondOneIsRefusedAndToldWhoHoldsIt) {
  const auto interface = "test" + std::to_string(::getpid());
  {
    const InstanceLock first(interface);
    EXPECT_NO_THROW(InstanceLock(interface + "b")) << "another interface";
    try {
      const InstanceLock second(interface);
      FAIL() << "two of them";
    } catch (const DeviceError& error) {
      EXPECT_THAT(error.what(), HasSubstr("process " + std::to_string(::getpid())));
      EXPECT_THAT(error.what(), HasSubstr("nothing was sent"));
    }
  }
  EXPECT_NO_THROW(InstanceLock{interface}) << "free again";
}

}  // namespace
}  // namespace sandhopper
