#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/diagnose/recordings/data_faults.hpp"

namespace sandhopper::diagnose {
namespace {

// An accelerometer that is limited at the end of its stated range has no fault; one that is limited below has
// one.
TEST(DiagnoseDataNotes, AnAccelerometerAtTheEndOfItsKnownRangeIsNoFault) {
  Belief belief;
  belief.numbers["sensors.imu_range_mps2"] = 156.9;
  for (const double limit : {156.9, 156.85, 150.0}) {
    DataFault clipped;
    clipped.channel = "imu_foot_accel_z_mps2";
    clipped.id = "imu.clipping";
    clipped.limit = limit;
    clipped.limit_resolution = 0.002;
    std::vector<DataFault> faults{clipped};
    const auto known = take_known_limits(faults, belief);
    EXPECT_EQ(known.size(), limit > 156.0 ? 1u : 0u) << limit;
    EXPECT_EQ(faults.size(), limit > 156.0 ? 0u : 1u) << limit;
  }
}

// A single stretch of equal samples in one of twelve trials is no fault of the sensor.
TEST(DiagnoseDataNotes, AStretchThatStoodStillOnceIsAnEvent) {
  DataFault once, often;
  once.id = often.id = "data.stuck";
  once.stretches = 1;
  often.stretches = 2;
  std::vector<DataFault> faults{once, often};
  EXPECT_EQ(take_single_events(faults, 12).size(), 1u);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults.front().stretches, 2u);
  faults = {once};
  EXPECT_TRUE(take_single_events(faults, 2).empty());
}

// A weight on a string holds the torque of each trial at one value; in other trials it is another one.
TEST(DiagnoseDataNotes, ATorqueThatIsConstantInEachTrialIsNoLimit) {
  auto r = swings([](double, double, double) { return 0.0; });
  for (std::size_t i = 0; i < r.trials.size(); ++i)
    std::ranges::fill(r.trials[i].channels["torque_Nm"], 0.5 * static_cast<double>(i + 1));
  for (const auto& fault : remove_data_faults(r.trials)) EXPECT_NE(fault.channel, "torque_Nm") << fault.id;
}

}  // namespace
}  // namespace sandhopper::diagnose
