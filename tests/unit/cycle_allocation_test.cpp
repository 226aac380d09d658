#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <memory>

#include "drivers/latest.hpp"
#include "firmware/cycle.hpp"
#include "firmware/live_status.hpp"
#include "tests/unit/allocation_guard.hpp"
#include "tools/plant/sim_board.hpp"

namespace sandhopper {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kCounted = false;
#else
constexpr bool kCounted = true;
#endif

// A board that allocates in one cycle. It proves that the guard detects this.
class LeakyBoard : public Board {
 public:
  LeakyBoard(Board& board, std::uint64_t plant_at) : board_(board), plant_at_(plant_at) {}
  void read(SensorFrame& frame) noexcept override { board_.read(frame); }
  void write(const Command& command) noexcept override {
    if (++writes_ == plant_at_) planted_ = std::make_unique<int>(1);
    board_.write(command);
  }

 private:
  Board& board_;
  std::uint64_t plant_at_;
  std::uint64_t writes_ = 0;
  std::unique_ptr<int> planted_;
};

struct Run {
  std::uint64_t allocations = 0;
  int strides = 0;
};

// A trial of three strides with logging and with the operator's view, each cycle under the guard.
Run run_trial(std::uint64_t plant_at) {
  // The name contains the process id, because tests of this file run in parallel.
  const auto log =
      std::filesystem::temp_directory_path() / fmt::format("sandhopper_allocation_test.{}.mcap", ::getpid());
  std::filesystem::remove(log);
  Run run;
  {
    TrialLogOptions options;
    options.mcap_file = log;
    TrialLogger logger(options);
    const TrialTopics topics(logger);
    logger.start();
    World world(WorldConfig{}, {}, 0);
    SimBoard sim(world);
    LeakyBoard board(sim, plant_at);
    Controller controller(CycleConfig{});
    Aftermath aftermath(StiffnessConfig{}, logger, topics, {});
    FreezeRing freeze({.file = log.string() + ".freeze.memory"});
    Cycle cycle({board, controller, logger, topics, aftermath, &freeze});
    LatencyHistogram latency;
    Latest<LiveStatus> status;
    Request request = Request::arm;
    for (std::uint64_t k = 1; k < 4000; ++k) {
      {
        const AllocationGuard guard;
        const auto& output = cycle.run(
            {.time_ns = static_cast<std::int64_t>(k) * kCyclePeriod_ns, .cycle = k, .request = request});
        latency.add(static_cast<std::int64_t>(k % 3000) * 1000);
        status.publish(live_status(cycle.frame(), output, latency));
        run.allocations += guard.count();
      }
      request = Request::none;
      for (const auto& event : controller.events())
        if (event.kind == EventKind::armed) request = Request::release;
      run.strides += controller.stride_finished();
    }
    logger.stop();
    logger.close();
    freeze.remove();
  }
  std::filesystem::remove(log);
  return run;
}

TEST(Cycle, AllocatesNothingThroughAWholeTrial) {
  if (!kCounted)
    GTEST_SKIP() << "NOT CHECKED: a sanitizer's malloc cannot be counted; the plain build checks this";
  const auto run = run_trial(0);
  EXPECT_EQ(run.strides, 3);
  EXPECT_EQ(run.allocations, 0U);
}

TEST(Cycle, TheGuardNoticesASinglePlantedAllocation) {
  if (!kCounted)
    GTEST_SKIP() << "NOT CHECKED: a sanitizer's malloc cannot be counted; the plain build checks this";
  EXPECT_EQ(run_trial(1000).allocations, 1U);
}

}  // namespace
}  // namespace sandhopper
