#include <gtest/gtest.h>

#include "config/files.hpp"
#include "drivers/clock.hpp"
#include "firmware/hop_session.hpp"
#include "tests/freeze/folders.hpp"
#include "tests/unit/allocation_guard.hpp"
#include "tools/plant/sim_board.hpp"

namespace sandhopper {
namespace {

class TestTime : public TimeSource {
 public:
  std::int64_t now_ns() noexcept override { return now_ns_; }
  void sleep_until(std::int64_t time_ns) noexcept override { now_ns_ = std::max(now_ns_, time_ns); }

 private:
  std::int64_t now_ns_ = 0;
};

// The simulated robot. The watchdog trips in turn 300, and the operator quits five turns later.
class TrippedBoard : public Board {
 public:
  explicit TrippedBoard(Heartbeat& heart) : heart_(heart), world_(WorldConfig{}, {}, 0), sim_(world_) {}
  void read(SensorFrame& frame) noexcept override { sim_.read(frame); }
  void write(const Command& command) noexcept override {
    sim_.write(command);
    if (++turn_ == 300) heart_.trip(25'000'000);
    if (turn_ == 305) quit = Quit::softly;
  }
  std::atomic<Quit> quit{Quit::no};

 private:
  Heartbeat& heart_;
  World world_;
  SimBoard sim_;
  int turn_ = 0;
};

std::uint64_t cycles_until_the_end(FreezeRing* ring) {
  auto robot = load_robot(std::filesystem::path(SANDHOPPER_SOURCE_DIR) / "config");
  robot.real_time = {.priority = 0, .lock_memory = false, .stack_prefault_kB = 0, .hold_cpu_awake = false};
  TrialLogOptions options;
  options.own_thread = false;
  TrialLogger logger(options);
  TestTime time;
  Heartbeat heart;
  TrippedBoard board(heart);
  HopSession session(robot, board, logger, {});
  RequestBox requests;
  return session
      .run({.quit = board.quit,
            .requests = requests,
            .heart = heart,
            .say = {},
            .time = time,
            .wall_clock = WallClock([] { return std::int64_t{0}; }),
            .freeze = ring})
      .cycles;
}

TEST(HopSessionWithAFreezeRing, ASoftEndWaitsForTheSecondAfterAFault) {
  Folders folders;
  FreezeRecorder recorder(folders.options());
  EXPECT_LT(cycles_until_the_end(nullptr), 400U);
  const auto cycles = cycles_until_the_end(recorder.ring());
  EXPECT_GE(cycles, 1301U);
  EXPECT_LE(cycles, 1310U);
  recorder.look();
  EXPECT_EQ(folders.told.size(), 1U) << "its frame is whole";
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(FreezeRing, APushAllocatesNothing) {
  Folders folders;
  FreezeRecorder recorder(folders.options());
  const std::array<Event, 8> events{};
  const AllocationGuard guard;
  for (int i = 0; i < 10'000; ++i) recorder.ring()->push(SensorFrame{}, StepOutput{}, events);
  EXPECT_EQ(guard.count(), 0U);
}
#endif

TEST(FreezeRing, APushTakesLessThanAMicrosecond) {
  Folders folders;
  FreezeRecorder recorder(folders.options());
  const SensorFrame frame;
  const StepOutput output;
  constexpr int kPushes = 100'000;
  const auto begin_ns = clock_ns(CLOCK_THREAD_CPUTIME_ID);
  for (int i = 0; i < kPushes; ++i) recorder.ring()->push(frame, output, {});
  const double push_ns = static_cast<double>(clock_ns(CLOCK_THREAD_CPUTIME_ID) - begin_ns) / kPushes;
  std::printf("%.0f ns a push, %zu bytes a cycle\n", push_ns, sizeof(freeze::Slot));
  EXPECT_LT(push_ns, 1000.0);
}

}  // namespace
}  // namespace sandhopper
