#include "drivers/can/drive_sequence.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "drivers/can/leave_confirmation.hpp"

namespace sandhopper {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::Not;

constexpr DriveFeedback kStill{.still = true, .left = false};
constexpr DriveFeedback kLeft{.still = true, .left = true};
constexpr DriveFeedback kMoving{.still = false, .left = false};

std::vector<DriveAction> actions(DriveSequence& sequence, DriveRequest request, int cycles,
                                 const DriveFeedback& feedback = kStill) {
  std::vector<DriveAction> out;
  out.reserve(static_cast<std::size_t>(cycles));
  for (int i = 0; i < cycles; ++i) out.push_back(sequence.next(request, feedback));
  return out;
}

TEST(DriveSequence, EntersOnceAfterClearingAndLeavesUntilItIsConfirmed) {
  using enum DriveAction;
  DriveSequence sequence(3);
  EXPECT_THAT(actions(sequence, DriveRequest::off, 4), ElementsAre(leave, zero, zero, leave));
  EXPECT_FALSE(sequence.energised());
  EXPECT_THAT(actions(sequence, DriveRequest::run, 7),
              ElementsAre(zero, zero, zero, leave, enter, zero, run));
  EXPECT_TRUE(sequence.energised());
  EXPECT_THAT(actions(sequence, DriveRequest::enable, 2), ElementsAre(zero, zero));
  EXPECT_THAT(actions(sequence, DriveRequest::off, 7),
              ElementsAre(zero, zero, zero, leave, leave, leave, leave));
  EXPECT_TRUE(sequence.leaving());
  EXPECT_TRUE(sequence.energised()) << "not confirmed";
  EXPECT_THAT(actions(sequence, DriveRequest::off, 4, kLeft), ElementsAre(zero, zero, zero, leave));
  EXPECT_FALSE(sequence.energised());
}

TEST(DriveSequence, OffWhileSwitchingOnNeverEnters) {
  DriveSequence sequence(100);
  actions(sequence, DriveRequest::enable, 2);
  EXPECT_THAT(actions(sequence, DriveRequest::off, 20), Not(Contains(DriveAction::enter)));
}

TEST(DriveSequence, AMovingMotorIsNotEntered) {
  using enum DriveAction;
  DriveSequence sequence(100);
  EXPECT_THAT(actions(sequence, DriveRequest::enable, 50, kMoving), Not(Contains(enter)));
  EXPECT_THAT(actions(sequence, DriveRequest::run, 3, kStill), ElementsAre(enter, zero, run));
}

TEST(DriveSequence, IsNotSwitchedOnAgainBeforeLeavingIsConfirmed) {
  DriveSequence sequence(100);
  actions(sequence, DriveRequest::run, 10);
  actions(sequence, DriveRequest::off, 5);
  EXPECT_THAT(actions(sequence, DriveRequest::run, 50), Each(DriveAction::leave));
}

constexpr double kConstant = 0.0868;
MotorSample sample(std::int64_t time_ns, double current_A) {
  MotorSample out;
  out.time_ns = time_ns;
  out.current_A = current_A;
  return out;
}

TEST(LeaveConfirmation, NeedsThreeSamplesWithoutTorqueFromAfterAFrameThatLeft) {
  LeaveConfirmation left;
  for (int i = 0; i < 10; ++i) left.see(sample(i, 0.0), kConstant);
  EXPECT_FALSE(left.confirmed()) << "no leave frame has been sent";
  left.sent(100);
  left.see(sample(99, 0.0), kConstant);
  left.see(sample(100, 0.3), kConstant);
  left.see(sample(101, 0.0), kConstant);
  EXPECT_FALSE(left.confirmed());
  left.see(sample(102, -0.3), kConstant);
  EXPECT_TRUE(left.confirmed());
  left.restart();
  EXPECT_FALSE(left.confirmed());
}

TEST(LeaveConfirmation, TorqueThatRemainsIsNoConfirmation) {
  LeaveConfirmation left;
  left.sent(1);
  for (int i = 1; i < 100; ++i) left.see(sample(i, i % 3 == 0 ? -8.0 : 0.0), kConstant);
  EXPECT_FALSE(left.confirmed());
}

}  // namespace
}  // namespace sandhopper
