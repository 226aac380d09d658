#include "firmware/watchdog/guard_process.hpp"

#include <gtest/gtest.h>
#include <linux/can/raw.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <functional>
#include <vector>

#include "config/files.hpp"
#include "drivers/can/can_socket.hpp"
#include "drivers/clock.hpp"
#include "firmware/watchdog/shared.hpp"

// The guard process on the virtual bench's bus. Times are virtual, so the scheduler has no influence.
namespace sandhopper {
namespace {

constexpr std::int64_t kMs = 1'000'000;

CanConfig can_config() {
  const auto directory = std::filesystem::path(SANDHOPPER_SOURCE_DIR) / "config";
  return load_linux_board(directory / "bench.toml", load_robot(directory)).can;
}

// Frames for motor 1 with the time at which they were on the bus.
class Bus {
 public:
  Bus() : socket_(can_config().interface, std::array{exact_standard_id(1)}) {}

  // Times [ms since `from_ns`] of the frames that make motor 1 leave motor mode.
  std::vector<double> leave_frames_ms(std::int64_t from_ns) {
    std::vector<double> times_ms;
    for (bool more = true; more;)
      for (const auto& received : socket_.receive(more))
        if (received.frame.can_id == 1 && received.frame.data[7] == 0xFD)
          times_ms.push_back(static_cast<double>(received.time_ns - from_ns) / kMs);
    return times_ms;
  }

 private:
  CanSocket socket_;
};

// Counts its calls in shared memory, and writes a byte to each of its descriptors that is open.
class CountingAct : public LastAct {
 public:
  CountingAct(int own, int other) : own_{own}, other_(other) {}
  void run() noexcept override {
    ++*calls_;
    sleep_ns(duration_ns);
    for (const int fd : {own_[0], other_})
      if (::write(fd, "x", 1) == 1) ++*written_;
  }
  std::span<const int> descriptors() const noexcept override { return own_; }
  int calls() const { return *calls_; }
  int written() const { return *written_; }
  std::int64_t duration_ns = 0;

 private:
  std::array<int, 1> own_;
  int other_;
  Shared<std::atomic<int>> calls_{0};
  Shared<std::atomic<int>> written_{0};
};

class GuardProcessOnBench : public ::testing::Test {
 protected:
  GuardProcess::Setup setup(LastAct* act = nullptr) {
    return {
        .cut = cut_, .heart = *heart_, .config = {.cycle_stall_s = 0.020, .priority = 0}, .last_act = act};
  }
  // Beats as the cycle does; returns the time of the last beat.
  std::int64_t beat_for(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      heart_->beat(State::flight, Fault::none);
      sleep_ns(kMs);
    }
    return monotonic_ns() - kMs;
  }
  std::vector<double> leave_frames_ms(std::int64_t from_ns) { return bus_.leave_frames_ms(from_ns); }

  Shared<Heartbeat> heart_;
  TorqueCut cut_{can_config()};
  Bus bus_;
};

TEST_F(GuardProcessOnBench, CutsDuringAStandstillUntilTheCycleHasLearntOfIt) {
  const GuardProcess guard(setup());
  const auto last_beat_ns = beat_for(50);
  sleep_ns(100 * kMs);
  auto times_ms = leave_frames_ms(last_beat_ns);
  ASSERT_GE(times_ms.size(), 10U) << "every 5 ms";
  EXPECT_GE(times_ms.front(), 25.0) << "the limit is 30 ms, and a beat is seen up to 5 ms late";
  EXPECT_LE(times_ms.front(), 36.0);
  EXPECT_TRUE(heart_->tripped());

  beat_for(50);
  EXPECT_GE(leave_frames_ms(0).size(), 8U) << "it beats, but has not taken the trip";
  EXPECT_GE(heart_->take_trip(), 30 * kMs);
  beat_for(10);
  leave_frames_ms(0);
  beat_for(200);
  EXPECT_TRUE(leave_frames_ms(0).empty()) << "nothing after that";
  EXPECT_FALSE(heart_->tripped());
}

TEST_F(GuardProcessOnBench, LeavesACycleAloneThatBeatsOrHasNotBegun) {
  const GuardProcess guard(setup());
  sleep_ns(500 * kMs);
  beat_for(500);
  heart_->end();
  sleep_ns(400 * kMs);
  EXPECT_TRUE(leave_frames_ms(0).empty());
  EXPECT_FALSE(heart_->tripped());
}

TEST_F(GuardProcessOnBench, CutsIfItIsNotDismissedSoonAfterTheCyclesEnd) {
  const GuardProcess guard(setup());
  beat_for(10);
  heart_->end();
  const auto end_ns = monotonic_ns();
  sleep_ns(600 * kMs);
  const auto times_ms = leave_frames_ms(end_ns);
  ASSERT_FALSE(times_ms.empty());
  EXPECT_GE(times_ms.front(), 500.0);
  EXPECT_LE(times_ms.front(), 511.0);
}

TEST_F(GuardProcessOnBench, DismissedItSendsNothingAbandonedItCuts) {
  { const GuardProcess guard(setup()); }
  EXPECT_TRUE(leave_frames_ms(0).empty());
  {
    GuardProcess guard(setup());
    guard.abandon();
  }
  EXPECT_EQ(leave_frames_ms(0).size(), 100U);
}

TEST_F(GuardProcessOnBench, CutsWithinAMillisecondOfADeathAndThenDoesItsLastAct) {
  int own[2], other[2];
  ASSERT_EQ(::pipe(own) + ::pipe(other), 0);
  CountingAct act(own[1], other[1]);
  const pid_t program = ::fork();
  if (program == 0) {
    const auto with_act = setup(&act);
    const GuardProcess guard(with_act);
    beat_for(1'000'000);
    ::_exit(0);
  }
  sleep_ns(50 * kMs);
  const auto killed_ns = monotonic_ns();
  ::kill(program, SIGKILL);
  ::waitpid(program, nullptr, 0);
  sleep_ns(200 * kMs);
  const auto times_ms = leave_frames_ms(killed_ns);
  ASSERT_EQ(times_ms.size(), 100U);
  EXPECT_LE(times_ms.front(), 1.0);
  EXPECT_NEAR(times_ms.back(), 99.0, 10.0);
  EXPECT_EQ(act.calls(), 1);
  EXPECT_EQ(act.written(), 1) << "only the descriptors that the act named are open";
  for (const int fd : {own[0], own[1], other[0], other[1]}) ::close(fd);
}

TEST_F(GuardProcessOnBench, TheLastActOfAStandstillRunsOnceAndDoesNotDelayTheCuts) {
  CountingAct act(-1, -1);
  act.duration_ns = 50 * kMs;
  {
    const auto with_act = setup(&act);
    GuardProcess guard(with_act);
    for (int standstill = 1; standstill <= 2; ++standstill) {
      const auto last_beat_ns = beat_for(50);
      sleep_ns(200 * kMs);
      EXPECT_EQ(act.calls(), standstill);
      const auto times_ms = leave_frames_ms(last_beat_ns);
      ASSERT_GE(times_ms.size(), 30U);
      for (std::size_t i = 1; i < times_ms.size(); ++i) EXPECT_LE(times_ms[i] - times_ms[i - 1], 6.0);
      heart_->beat(State::flight, Fault::none);
      heart_->take_trip();
    }
    beat_for(20);
  }
  EXPECT_EQ(act.calls(), 2) << "none after a dismissal";
}

TEST_F(GuardProcessOnBench, HasASessionOfItsOwnAndIgnoresWhatCanBeIgnored) {
  GuardProcess guard(setup());
  const pid_t child = guard.process_id();
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGTSTP, SIGQUIT, SIGABRT}) ::kill(child, signal);
  sleep_ns(10 * kMs);
  EXPECT_EQ(::getsid(child), child);
  EXPECT_TRUE(guard.alive());
  ::kill(child, SIGKILL);
  sleep_ns(10 * kMs);
  EXPECT_FALSE(guard.alive()) << "and the loss of it is seen";
}

}  // namespace
}  // namespace sandhopper
