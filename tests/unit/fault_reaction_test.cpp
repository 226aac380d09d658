#include "firmware/fault_reaction.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sandhopper {
namespace {

constexpr std::int64_t kMs = 1'000'000;

struct Reacting {
  explicit Reacting(bool law_in_drive) {
    config.law_in_drive = {law_in_drive, law_in_drive};
    for (auto& motor : frame.motor) motor.position_rad = 1.2;
    see(0, {0, 0});
  }
  // Sets the frame at `time_ms` with motor samples of these ages.
  void see(std::int64_t time_ms, std::array<std::int64_t, kMotorCount> age_ms) {
    frame.time_ns = 1'000 * kMs + time_ms * kMs;
    for (std::size_t i = 0; i < kMotorCount; ++i) frame.motor[i].time_ns = frame.time_ns - age_ms[i] * kMs;
  }
  Command react(Reaction kind, std::int64_t time_ms, std::array<std::int64_t, kMotorCount> age_ms) {
    see(time_ms, age_ms);
    Command command;
    reaction.write(frame, kind, 1e-3 * static_cast<double>(time_ms), command);
    return command;
  }

  CycleConfig config;
  FaultReaction reaction{config};
  SensorFrame frame;
};

bool damps(const Command& c, std::size_t motor) { return c.motor[motor].kd_Nm_s_per_rad > 0.0; }
bool holds(const Command& c, std::size_t motor) { return c.motor[motor].kp_Nm_per_rad > 0.0; }

TEST(FaultReaction, ADriveWithItsOwnLawNeedsNoSampleToDamp) {
  Reacting r(true);
  r.reaction.begin(r.frame, true);
  const auto command = r.react(Reaction::damp, 900, {900, 900});
  EXPECT_EQ(command.drive, DriveRequest::run);
  EXPECT_TRUE(damps(command, 0) && damps(command, 1));
}

TEST(FaultReaction, WhereTheHostDampsAnOldVelocityGivesNoTorque) {
  Reacting r(false);
  r.reaction.begin(r.frame, true);
  auto command = r.react(Reaction::damp, 5, {2, 6});
  EXPECT_TRUE(damps(command, 0) && damps(command, 1)) << "not older than 6 ms";
  command = r.react(Reaction::damp, 6, {2, 7});
  EXPECT_EQ(command.drive, DriveRequest::run);
  EXPECT_TRUE(damps(command, 0)) << "each motor by itself";
  EXPECT_FALSE(damps(command, 1));
  EXPECT_EQ(command.motor[1].torque_Nm, 0.0);
  command = r.react(Reaction::damp, 8, {2, 0});
  EXPECT_TRUE(damps(command, 1)) << "a fresh velocity is good again";
  command = r.react(Reaction::damp, 20, {7, 7});
  EXPECT_EQ(command.drive, DriveRequest::off) << "no motor can damp";
  command = r.react(Reaction::damp, 21, {0, 0});
  EXPECT_EQ(command.drive, DriveRequest::off) << "and the drives are not switched on again";
}

TEST(FaultReaction, HoldingNeedsThePositionAtTheFault) {
  Reacting r(true);
  r.see(0, {0, 7});
  r.reaction.begin(r.frame, true);
  const auto command = r.react(Reaction::hold, 1, {0, 0});
  EXPECT_FALSE(holds(command, 0) || holds(command, 1));
  EXPECT_TRUE(damps(command, 0) && damps(command, 1)) << "the next safer one";
  r.frame.motor[0].position_rad = std::nan("");
  r.see(2, {0, 0});
  r.reaction.begin(r.frame, true);
  EXPECT_FALSE(holds(r.react(Reaction::hold, 3, {0, 0}), 1)) << "a position that is no number";
}

TEST(FaultReaction, OneMotorThatCannotHoldEndsTheHoldForGood) {
  Reacting r(false);
  r.reaction.begin(r.frame, true);
  EXPECT_TRUE(holds(r.react(Reaction::hold, 1, {0, 0}), 0));
  EXPECT_FALSE(holds(r.react(Reaction::hold, 2, {0, 7}), 0));
  const auto command = r.react(Reaction::hold, 3, {0, 0});
  EXPECT_FALSE(holds(command, 0) || holds(command, 1));
  EXPECT_TRUE(damps(command, 0) && damps(command, 1));
}

TEST(FaultReaction, EndsInItsTimesAndNeverComesBack) {
  Reacting r(true);
  r.reaction.begin(r.frame, true);
  EXPECT_TRUE(holds(r.react(Reaction::hold, 499, {0, 0}), 0));
  EXPECT_FALSE(holds(r.react(Reaction::hold, 500, {0, 0}), 0));
  EXPECT_TRUE(damps(r.react(Reaction::hold, 1499, {0, 0}), 0));
  EXPECT_EQ(r.react(Reaction::hold, 1500, {0, 0}).drive, DriveRequest::off);
  EXPECT_EQ(r.react(Reaction::damp, 0, {0, 0}).drive, DriveRequest::off)
      << "a harsher fault after the drives went off does not switch them on again";
}

TEST(FaultReaction, DrivesThatMadeNoTorqueAreNotSwitchedOnByAFault) {
  Reacting r(true);
  r.reaction.begin(r.frame, false);
  EXPECT_EQ(r.react(Reaction::damp, 0, {0, 0}).drive, DriveRequest::off);
  r.reaction.begin(r.frame, true);
  EXPECT_EQ(r.react(Reaction::limp, 0, {0, 0}).drive, DriveRequest::off);
}

}  // namespace
}  // namespace sandhopper
