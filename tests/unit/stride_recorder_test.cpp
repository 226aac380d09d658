#include "firmware/stride_recorder.hpp"

#include <gtest/gtest.h>

#include "campaign_folder.hpp"
#include "tools/trial/replay.hpp"
#include "tools/trial/sim_trial.hpp"

namespace sandhopper {
namespace {

// If the accelerometer reached its range, the stride's line is not valid. So the solver needs the number of
// these samples.
TEST(StrideRecorder, SamplesAtTheAccelerometersRangeOnNewGroundAreCounted) {
  const CampaignFolder folder;
  SimTrialSetup setup{.trial = {.release_height_m = 0.0618}, .log = folder.path() / "clipped.mcap"};
  setup.robot.limits.strides = 1;
  setup.robot.stiffness.joint.accel_range_mps2 = 20.0;
  run_sim_trial(setup);
  int saturated = 0;
  replay_log(setup.log, {}, [&](const StrideSums& sums) { saturated += sums.profile.saturated; });
  EXPECT_GT(saturated, 0);
}

}  // namespace
}  // namespace sandhopper
