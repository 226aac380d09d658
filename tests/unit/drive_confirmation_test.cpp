#include "firmware/drive_confirmation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "firmware/drive_enable.hpp"
#include "firmware/operator_text.hpp"
#include "firmware/refusal_text.hpp"

namespace sandhopper {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::int64_t kMs = 1'000'000;

// Two motors whose currents follow the command with `gain` and an offset, two cycles late.
struct Motors {
  std::array<double, kMotorCount> gain{1.0, 1.0};
  double offset_A = 0.0;
  std::array<std::array<double, 3>, kMotorCount> past_A{};

  void answer(SensorFrame& frame, const CycleConfig& config, const DriveConfirmation& drives) {
    for (std::size_t i = 0; i < kMotorCount; ++i) {
      auto& past = past_A[i];
      past = {drives.torque_Nm(i) / config.torque_constant_Nm_per_A[i], past[0], past[1]};
      frame.motor[i].fresh = true;
      frame.motor[i].current_A = gain[i] * past[2] + offset_A;
    }
  }
};

struct Outcome {
  DriveConfirmation::Result result = DriveConfirmation::Result::pending;
  int cycles = 0;
  int off_cycles = 0;
  double most_sum_Nm = 0.0;
};

Outcome run(const CycleConfig& config, DriveConfirmation& drives, Motors& motors) {
  Outcome out;
  SensorFrame frame;
  drives.begin(0);
  while (out.result == DriveConfirmation::Result::pending && out.cycles < 5000) {
    frame.time_ns = ++out.cycles * kMs;
    motors.answer(frame, config, drives);
    out.result = drives.update(frame);
    out.off_cycles += drives.drive() == DriveRequest::off;
    out.most_sum_Nm = std::max(out.most_sum_Nm, std::abs(drives.torque_Nm(0) + drives.torque_Nm(1)));
  }
  return out;
}

TEST(DriveConfirmation, BothThatFollowAreConfirmedInTheStatedTimeAndActAgainstEachOther) {
  const CycleConfig config;
  for (const double offset_A : {0.0, 3.0, -3.0}) {
    DriveConfirmation drives(config);
    Motors motors{.offset_A = offset_A};
    const auto out = run(config, drives, motors);
    EXPECT_EQ(out.result, DriveConfirmation::Result::confirmed) << "an offset of " << offset_A << " A";
    EXPECT_EQ(out.cycles, 50);
    EXPECT_EQ(out.off_cycles, 0);
    EXPECT_EQ(out.most_sum_Nm, 0.0);
    EXPECT_NEAR(drives.measured_Nm()[1], 0.1, 1e-9);
  }
}

TEST(DriveConfirmation, OneThatDoesNotFollowIsTriedThreeTimesWithTheDrivesOffBetween) {
  const CycleConfig config;
  for (const double gain : {0.0, 0.4, -1.0, 1.6}) {
    DriveConfirmation drives(config);
    Motors motors{.gain = {1.0, gain}};
    const auto out = run(config, drives, motors);
    EXPECT_EQ(out.result, DriveConfirmation::Result::refused) << gain;
    EXPECT_EQ(drives.tries(), 3);
    EXPECT_EQ(out.cycles, 3 * 50 + 2 * 20);
    EXPECT_EQ(out.off_cycles, 2 * 20);
    EXPECT_NEAR(drives.measured_Nm()[0], 0.1, 1e-9);
    EXPECT_NEAR(drives.measured_Nm()[1], 0.1 * gain, 1e-9);
  }
}

TEST(DriveConfirmation, TheTextNamesTheMotorAndTheCure) {
  Event event;
  event.kind = EventKind::arming_refused;
  event.reason = Reason::drives_not_confirmed;
  event.values = {0.101, 0.002, 0.1, 3.0};
  const auto text = refusal_text(event);
  EXPECT_THAT(text, HasSubstr("right motor: 0.10 N m commanded, 0.00 N m measured, after 3 tries"));
  EXPECT_THAT(text, Not(HasSubstr("left")));
  EXPECT_THAT(text, HasSubstr("power-cycle the drive"));
  EXPECT_THAT(operator_text(event), HasSubstr(R"("text":"right motor)"));
  event.values = {0.0, kNotMeasured, 0.1, 3.0};
  EXPECT_THAT(refusal_text(event), Not(HasSubstr("right motor"))) << "a leg with one motor";
  event.reason = Reason::moving;
  EXPECT_EQ(refusal_text(event), "");
  EXPECT_THAT(operator_text(event), Not(HasSubstr("text")));
}

TEST(DriveEnable, IsActiveFromTheStartAndDropsOnceForGood) {
  std::vector<bool> levels;
  {
    DriveEnable relay([&](bool active) {
      levels.push_back(active);
      return levels.size() != 2;  // the first attempt to open the relay fails
    });
    EXPECT_EQ(levels, std::vector<bool>{true});
    relay.drop();
    EXPECT_FALSE(relay.dropped());
    relay.drop();
    relay.drop();
    EXPECT_TRUE(relay.dropped());
  }
  EXPECT_EQ(levels, (std::vector<bool>{true, false, false}));
}

}  // namespace
}  // namespace sandhopper
