#include "drivers/transmit_guard/guarded_port.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "tests/transmit_guard/frames.hpp"
#include "tests/unit/allocation_guard.hpp"

namespace sandhopper {
namespace {

using transmit::enter;
using transmit::mit_law;
using transmit::mit_reply;

// A port that keeps the frames that were sent and delivers planned answers.
class Wire final : public CanPort {
 public:
  Wire() { sent.reserve(1000); }
  void begin_cycle() noexcept override { ++cycles; }
  std::optional<std::int64_t> send(const can_frame& frame) noexcept override {
    if (blocked) return std::nullopt;
    sent.push_back(frame);
    return 1'000'000 * cycles;
  }
  std::span<const ReceivedFrame> receive(bool& more) noexcept override {
    more = false;
    batch[0] = {.frame = mit_reply(1), .time_ns = 1'000'000 * cycles};
    return {batch.data(), answering ? std::size_t{1} : std::size_t{0}};
  }
  void pause(std::int64_t) noexcept override {}
  bool wait(std::int64_t) noexcept override { return answering; }
  const CanCounters& counters() const noexcept override { return counted; }
  void set_tap(CanTap*) noexcept override {}

  std::vector<can_frame> sent;
  std::array<ReceivedFrame, 1> batch{};
  CanCounters counted{};
  bool blocked = false, answering = true;
  std::int64_t cycles = 0;
};

struct RefusedTap final : CanTap {
  void on_frame(const can_frame&, std::int64_t, bool) noexcept override {}
  void on_refused(const can_frame& frame, std::int64_t) noexcept override { refused.push_back(frame); }
  std::vector<can_frame> refused;
};

struct Bench {
  Bench() : guarded(make_wire(), transmit::Limits{}) { guarded.set_tap(&tap); }
  std::unique_ptr<CanPort> make_wire() {
    auto made = std::make_unique<Wire>();
    wire = made.get();
    return made;
  }
  std::optional<std::int64_t> cycle(const can_frame& frame) {
    guarded.drain([](const ReceivedFrame&) {});
    guarded.begin(
        {.now_ns = 1'000'000 * ++cycles, .allowance = transmit::Allowance::motion, .emergency_stop = false});
    guarded.begin_cycle();
    return guarded.send(frame);
  }
  void confirm() {
    cycle(enter(1));
    for (int i = 0; i < 3; ++i) cycle(mit_law(1, {}));
  }
  Wire* wire = nullptr;
  RefusedTap tap;
  GuardedPort guarded;
  std::int64_t cycles = 0;
};

TEST(GuardedPort, SendsWhatPassesAndTellsWhen) {
  Bench bench;
  bench.confirm();
  const auto frame = mit_law(1, {.torque_Nm = 1.0});
  EXPECT_TRUE(bench.cycle(frame));
  EXPECT_EQ(0, std::memcmp(&bench.wire->sent.back(), &frame, sizeof frame));
  EXPECT_EQ(bench.guarded.refused().count, 0U);
}

TEST(GuardedPort, SendsACommandWithoutTorqueInPlaceOfOneItRefuses) {
  Bench bench;
  bench.confirm();
  const auto frame = mit_law(1, {.torque_Nm = 5.0});
  EXPECT_FALSE(bench.cycle(frame));
  const auto& zero = bench.guarded.guard().zero_frame(0);
  EXPECT_EQ(0, std::memcmp(&bench.wire->sent.back(), &zero, sizeof zero));
  const auto& refused = bench.guarded.refused();
  EXPECT_EQ(refused.count, 1U);
  EXPECT_EQ(refused.rule, transmit::Rule::torque);
  EXPECT_EQ(refused.can_id, 1U);
  EXPECT_TRUE(std::equal(refused.data.begin(), refused.data.end(), frame.data));
  ASSERT_EQ(bench.tap.refused.size(), 1U);
  EXPECT_EQ(0, std::memcmp(&bench.tap.refused[0], &frame, sizeof frame));
}

TEST(GuardedPort, KeepsTheFirstRefusedFrameAndCountsTheOthers) {
  Bench bench;
  bench.cycle(mit_law(7, {}));
  bench.cycle(mit_law(1, {.torque_Nm = 5.0}));
  EXPECT_EQ(bench.guarded.refused().count, 2U);
  EXPECT_EQ(bench.guarded.refused().rule, transmit::Rule::identifier);
  EXPECT_EQ(bench.guarded.refused().can_id, 7U);
}

TEST(GuardedPort, SendsNothingInPlaceOfAnEnterFrameOrOneOfNoMotor) {
  Bench bench;
  bench.confirm();
  bench.cycle(mit_law(1, {.torque_Nm = 1.0}));
  const auto before = bench.wire->sent.size();
  EXPECT_FALSE(bench.cycle(enter(1)));
  EXPECT_FALSE(bench.cycle(mit_law(7, {})));
  EXPECT_EQ(bench.wire->sent.size(), before);
}

// A frame that the kernel refused has not reached the drive.
TEST(GuardedPort, DoesNotTakeAnEnterFrameForSentThatThePortDidNotTake) {
  Bench bench;
  bench.wire->blocked = true;
  EXPECT_FALSE(bench.cycle(enter(1)));
  bench.wire->blocked = false;
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(bench.cycle(mit_law(1, {})));
  EXPECT_FALSE(bench.guarded.guard().confirmed(0));
  EXPECT_FALSE(bench.cycle(mit_law(1, {.torque_Nm = 0.1})));
  EXPECT_EQ(bench.guarded.refused().rule, transmit::Rule::not_confirmed);
}

TEST(GuardedPort, AllocatesNothing) {
  Bench bench;
  bench.tap.refused.reserve(100);
  const AllocationGuard allocations;
  bench.confirm();
  for (int i = 0; i < 50; ++i) bench.cycle(mit_law(1, {.torque_Nm = 0.1 * i}));
  bench.cycle(transmit::set_zero(1));
  EXPECT_EQ(allocations.count(), 0U);
  EXPECT_GT(bench.guarded.refused().count, 10U);
}

}  // namespace
}  // namespace sandhopper
