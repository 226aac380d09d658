#include <gtest/gtest.h>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/diagnose/recordings/contradicted_ranges.hpp"

namespace sandhopper::diagnose {
namespace {

// The largest angle of these swings.
double farthest_rad(const Recordings& recordings) {
  double farthest = 0.0;
  for (const auto& trial : recordings.trials)
    for (const double q : trial.channels.at("position_rad")) farthest = std::max(farthest, std::abs(q));
  return farthest;
}

// An angle that goes past the stated range was not clipped there. One that ends at the range, or that only
// noise carries past it, says nothing against it.
TEST(DiagnoseContradictedRanges, ARangeHoldsUnlessTheRecordingGoesClearlyPastIt) {
  const auto range_after = [](double share, double noise_share) {
    auto recordings = swings([](double, double, double) { return 0.0; });
    const double range = share * farthest_rad(recordings);
    recordings.belief.numbers["sensors.position_range_rad"] = range;
    for (auto& belief : recordings.beliefs) belief.numbers["sensors.position_range_rad"] = range;
    Random random(3, 0);
    for (auto& trial : recordings.trials)
      for (double& q : trial.channels["position_rad"]) q += noise_share * range * random.normal();
    const auto notes = drop_contradicted_ranges(recordings);
    EXPECT_EQ(notes.empty(), recordings.beliefs.front().numbers.contains("sensors.position_range_rad"));
    return recordings.belief.value("sensors.position_range_rad");
  };
  EXPECT_EQ(range_after(0.8, 0.0), 0.0);
  EXPECT_GT(range_after(1.0, 0.0), 0.0);
  EXPECT_GT(range_after(1.0, 0.02), 0.0);
}

// A range that is stated to three digits may be a thousandth too small.
TEST(DiagnoseContradictedRanges, ARangeMayBeRoundedByAThousandth) {
  const auto holds = [](double beyond) {
    Recordings recordings;
    recordings.belief.numbers["sensors.position_range_rad"] = 1.0;
    Trial trial;
    for (int i = 0; i < 200; ++i) {
      trial.time_s.push_back(0.01 * i);
      trial.channels["position_rad"].push_back((1.0 + beyond) * i / 199.0);
    }
    recordings.trials = {trial};
    recordings.beliefs = {recordings.belief};
    return drop_contradicted_ranges(recordings).empty();
  };
  EXPECT_TRUE(holds(7e-4));
  EXPECT_FALSE(holds(1.5e-3));
}

}  // namespace
}  // namespace sandhopper::diagnose
