#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "drivers/imu/imu_config.hpp"
#include "terrain/strength_profile.hpp"
#include "tests/unit/profile_pushes.hpp"
#include "tools/plant/world_config.hpp"

// Depth at which the foot is found in contact, and its effect on the profile.
namespace sandhopper {
namespace {

const ProfileConfig kPrior{};
const double kThreshold_N = StiffnessConfig{}.contact_force_N - kPrior.contact_early_N;
const double kCone_kg_per_m = Bed(BedParameters{}, kRadius_m).added_mass_gradient_kg_per_m(0.0);

// Contact is found at a force. A slow foot is then deeper on softer ground. A fast one is not, because the
// added mass alone gives that force.
TEST(ProfileContact, ASlowFootOnSoftGroundIsDeepWhenItIsFound) {
  constexpr double kSlow_mps = 0.1, kFast_mps = 1.0;
  const auto contact = [&](double stiffness_N_per_m, double speed_mps) {
    StiffnessConfig config;
    config.profile = ProfileConfig{.believed_stiffness_N_per_m = stiffness_N_per_m};
    config.joint.intercept_depth_m = 0.0;
    return ProfileSolver(config).contact_depth(speed_mps, kCone_kg_per_m);
  };
  const double needed_N = kThreshold_N - kCone_kg_per_m * kSlow_mps * kSlow_mps;
  for (const double stiffness : {1000.0, 3000.0}) {
    const auto depth = contact(stiffness, kSlow_mps);
    EXPECT_NEAR(depth.mean_m, needed_N / stiffness + (kAccelLowPass_s + kPrior.contact_time_s) * kSlow_mps,
                1e-8);
    EXPECT_GT(depth.variance_m2, std::pow(kPrior.contact_force_sd_N / stiffness, 2));
  }
  // A blow of 15 N exceeds the threshold after 8 % of the low-pass's time constant.
  const double blow_N = kCone_kg_per_m * kFast_mps * kFast_mps;
  const double time_s = -kAccelLowPass_s * std::log(1.0 - kThreshold_N / blow_N);
  EXPECT_NEAR(contact(1000.0, kFast_mps).mean_m, (time_s + kPrior.contact_time_s) * kFast_mps, 1e-7);
  EXPECT_LT(kPrior.contact_time_s, 0.0);        // the accelerometer feels the blow before the motors reply
  EXPECT_EQ(contact(1000.0, 0.0).mean_m, 0.0);  // contact was not found by its force
}

double stiff_N(double z) { return 1200.0 * z; }

// Depth of a foot whose force grows by the curve alone, behind the low-pass.
double depth_without_blow_m(double speed_mps) {
  return kThreshold_N / 1200.0 + (kAccelLowPass_s + kPrior.contact_time_s) * speed_mps;
}

// On ground without inertia a fast foot is deep, too, and the first stride does not exclude such a ground. On
// sand it is found at the surface.
TEST(ProfileContact, AFastFootOnGroundWithoutInertiaIsDeepWhenItIsFound) {
  constexpr double kFast_mps = 0.9;
  constexpr unsigned kStrides = 12;
  int held = 0, all = 0;
  for (unsigned seed = 1; seed <= kStrides; ++seed) {
    const double true_m = depth_without_blow_m(kFast_mps);
    ProfileSolver solver{StiffnessConfig{}};
    solver.add(sums_of(stiff_N, {.speed_mps = kFast_mps,
                                 .too_deep_m = -true_m,
                                 .added_mass = 0.0,
                                 .seed = seed,
                                 .lasts = 1.8,
                                 .contact = true}),
               1);
    const auto depth = solver.contact_depth(kFast_mps, kCone_kg_per_m);
    EXPECT_GT(depth.mean_m, 0.3 * true_m) << seed;
    EXPECT_LT(std::abs(depth.mean_m - true_m), 2.5 * std::sqrt(depth.variance_m2)) << seed;
    for (double z = 0.005; z < 0.035; z += 0.001, ++all) {
      const auto force = solver.force_N(z);
      held += force.low() < stiff_N(z) && stiff_N(z) < force.high();
    }
    const auto sand = solved(stiff_N, {.speed_mps = kFast_mps, .seed = seed, .contact = true})
                          .contact_depth(kFast_mps, kCone_kg_per_m);
    EXPECT_LT(std::abs(sand.mean_m), 0.3e-3) << seed;
    EXPECT_LT(std::sqrt(sand.variance_m2), 0.5e-3) << seed;
  }
  EXPECT_GE(static_cast<double>(held) / all, 0.9);
}

// The time constant of the low-pass is that of the accelerometer as it is set up, and as it is simulated.
TEST(ProfileContact, TheLowPassIsThatOfTheAccelerometer) {
  const auto time_constant_s = [](double bandwidth_Hz) { return 0.5 / (std::numbers::pi * bandwidth_Hz); };
  const ImuConfig imu;
  EXPECT_NEAR(kAccelLowPass_s, time_constant_s(imu.rate_Hz / imu.accel_lowpass_divisor), 2e-5);
  EXPECT_NEAR(kAccelLowPass_s, time_constant_s(SensorConfig{}.imu_bandwidth_Hz), 2e-5);
}

}  // namespace
}  // namespace sandhopper
