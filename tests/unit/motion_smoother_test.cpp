#include "estimation/motion_smoother.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tools/plant/random.hpp"

namespace sandhopper {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// A foot that oscillates by 20 mm at 3 Hz; camera at 240 Hz with 0.2 mm of noise, accelerometer at 1 kHz with
// a bias.
struct Recording {
  std::vector<double> t_s, position_m, accel_mps2, velocity_mps;
  double omega = 2.0 * 3.14159265358979 * 3.0;

  explicit Recording(double bias_mps2, bool camera_gap = false) {
    Random random(5, 1);
    double next_frame_s = 0.0;
    for (int i = 0; i < 1000; ++i) {
      const double t = 1e-3 * i;
      t_s.push_back(t);
      velocity_mps.push_back(0.02 * omega * std::cos(omega * t));
      accel_mps2.push_back(-0.02 * omega * omega * std::sin(omega * t) + bias_mps2 + 0.3 * random.normal());
      const bool frame = t >= next_frame_s && !(camera_gap && t > 0.4 && t < 0.5);
      if (t >= next_frame_s) next_frame_s += 1.0 / 240.0;
      position_m.push_back(frame ? 0.02 * std::sin(omega * t) + 2e-4 * random.normal() : kNone);
    }
  }
  double velocity_error_rms(const SmoothMotion& motion) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < t_s.size(); ++i) sum += std::pow(motion.velocity_mps[i] - velocity_mps[i], 2);
    return std::sqrt(sum / static_cast<double>(t_s.size()));
  }
};

TEST(MotionSmoother, SpeedIsGoodToFiveMillimetresPerSecondInSpiteOfTheBias) {
  const Recording recording(0.4);
  const auto motion = smooth_motion(recording.t_s, recording.position_m, recording.accel_mps2);
  EXPECT_LT(recording.velocity_error_rms(motion), 0.005);
  EXPECT_GT(recording.velocity_error_rms(motion), 1e-4) << "too good to be true";
  EXPECT_NEAR(motion.accel_mps2[500], -0.02 * std::pow(recording.omega, 2) * std::sin(recording.omega * 0.5),
              1.2);
}

TEST(MotionSmoother, BridgesATenthOfASecondWithoutTheCamera) {
  const Recording recording(0.4, true);
  const auto motion = smooth_motion(recording.t_s, recording.position_m, recording.accel_mps2);
  EXPECT_LT(recording.velocity_error_rms(motion), 0.008);
}

TEST(MotionSmoother, FollowsPositionsAloneLessWell) {
  const Recording recording(0.0);
  const auto both = smooth_motion(recording.t_s, recording.position_m, recording.accel_mps2);
  const auto alone =
      smooth_motion(recording.t_s, recording.position_m, std::vector<double>(recording.t_s.size(), kNone));
  EXPECT_LT(recording.velocity_error_rms(alone), 0.06);
  EXPECT_GT(recording.velocity_error_rms(alone), 2.0 * recording.velocity_error_rms(both));
}

TEST(MotionSmoother, SaysNothingWithoutPositions) {
  const std::vector<double> t{0.0, 0.1}, none{kNone, kNone}, one{1.0, 1.0};
  EXPECT_TRUE(std::isnan(smooth_motion(t, none, one).velocity_mps[0]));
}

}  // namespace
}  // namespace sandhopper
