#include "tools/diagnose/plants/intruder/bed_grains.hpp"

#include <gtest/gtest.h>

namespace sandhopper::diagnose {
namespace {

// A press of half the correlation length: the knots stand for the fluctuation, and little is left between
// them as noise. A press of many lengths has as many knots, and the noise between them is that of the grains.
TEST(BedGrains, AShallowPressHasAsManyKnotsAsADeepOne) {
  constexpr double kRelative = 0.02, kLength_m = 2e-3;
  constexpr std::size_t kKnots = 17;
  const auto press = [&](double deepest_m) {
    return BedGrains(kRelative, kLength_m, deepest_m, deepest_m / (kKnots - 2.0), kKnots);
  };
  EXPECT_EQ(press(0.001).count(), kKnots);
  EXPECT_EQ(press(0.2).count(), kKnots);
  EXPECT_LT(press(0.001).between_knots(), 0.15 * kRelative);
  EXPECT_DOUBLE_EQ(press(0.2).between_knots(), kRelative);
}

}  // namespace
}  // namespace sandhopper::diagnose
