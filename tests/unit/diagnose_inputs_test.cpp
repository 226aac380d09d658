#include <gtest/gtest.h>

#include "tools/diagnose/plants/inputs.hpp"
#include "tools/plant/random.hpp"

// Noise of a recorded channel.
namespace sandhopper::diagnose {
namespace {

// A body that sinks through 0.3 m, with most rows missing.
Samples sinking(double noise_m) {
  Samples s;
  Random random(7, 1);
  for (int i = 0; i < 8000; ++i) {
    const double t = 0.05 * i, noise = noise_m * random.normal();
    if (random.uniform() < 0.6) continue;
    s.time_s.push_back(t);
    s.value.push_back(0.3 - 0.02 * t + 2e-5 * t * t + noise);
  }
  return s;
}

TEST(DiagnoseInputs, MissingRowsAreNoNoise) { EXPECT_LT(fluctuation_rms(sinking(0.0)), 1e-12); }

TEST(DiagnoseInputs, NoiseIsMeasuredBetweenMissingRows) {
  constexpr double kNoise_m = 3e-4;
  EXPECT_NEAR(fluctuation_rms(sinking(kNoise_m)), kNoise_m, 0.15 * kNoise_m);
}

TEST(DiagnoseInputs, FewSamplesHaveNoNoise) {
  EXPECT_EQ(fluctuation_rms({{0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0}, {1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0}}),
            0.0);
}

}  // namespace
}  // namespace sandhopper::diagnose
