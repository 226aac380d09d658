#include "terrain/falling_body.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "terrain/accelerometer_fusion.hpp"
#include "terrain/resistance_law.hpp"

namespace sandhopper {
namespace {

constexpr double kGravity = 9.81, kStep_s = 5e-4;

// A body that is released in water, falls for 2 s, enters a bed with r = k z^1.5 v^0.2 and comes to rest.
struct Drop {
  std::vector<double> t_s, specific_force_mps2, speed_mps, depth_m;
  std::size_t touchdown = 0;
};
Drop drop(double alpha, double kappa_per_m, double k) {
  Drop out;
  double v = 0.0, z = 0.0;
  bool at_rest = false;
  for (int i = 0; i < 8000; ++i) {
    const double t = i * kStep_s;
    const bool in_bed = t > 2.0;
    if (in_bed && out.touchdown == 0) out.touchdown = out.t_s.size();
    double accel = t < 0.3 ? 0.0 : alpha * kGravity - kappa_per_m * v * v;
    if (in_bed && v > 0.0) accel -= k * std::pow(z / 0.1, 1.5) * std::pow(v, 0.2);
    at_rest |= in_bed && v + accel * kStep_s <= 0.0;
    if (at_rest) accel = -v / kStep_s;
    out.t_s.push_back(t);
    out.specific_force_mps2.push_back(kGravity - accel);
    out.speed_mps.push_back(v);
    out.depth_m.push_back(z);
    v += accel * kStep_s;
    if (in_bed) z += v * kStep_s;
  }
  return out;
}

std::vector<double> noisy(std::vector<double> values, double sigma, unsigned seed) {
  std::mt19937_64 rng(seed);
  std::normal_distribution<double> normal(0.0, sigma);
  for (double& value : values) value += normal(rng);
  return values;
}

TEST(FallingBody, SpeedFromRestNeedsNoReleaseAndNoBias) {
  const auto truth = drop(0.7, 0.33, 6.0);
  auto biased = noisy(truth.specific_force_mps2, 0.05, 1);
  for (double& f : biased) f -= 0.08;
  const auto rest = find_rest(biased, 41, 1000, 0.2);
  ASSERT_LT(rest, biased.size());
  const auto motion = speed_from_rest(truth.t_s, biased, kGravity, rest);
  EXPECT_NEAR(motion.bias_mps2, 0.08, 0.01);
  for (const std::size_t row : {truth.touchdown, truth.touchdown + 100})
    EXPECT_NEAR(motion.speed_mps[row], truth.speed_mps[row], 0.02);
}

TEST(FallingBody, TouchdownIsWhereTheForceLeavesItsTrend) {
  const auto truth = drop(0.7, 0.33, 20.0);
  const auto found = find_touchdown(truth.t_s, noisy(truth.specific_force_mps2, 0.1, 2), 21, 0.6, 4.0);
  EXPECT_NEAR(truth.t_s[found.row], truth.t_s[truth.touchdown], 0.02);
  EXPECT_GT(found.peak_row, truth.touchdown);
}

TEST(FallingBody, FallGivesTheRatiosAndTheMassGivesTheRest) {
  const FluidBody body{9.0, 2.473e-3, 6.013e-3, 1000.0};
  const double moving_kg = body.mass_kg + 0.4 * 2.473;
  const double alpha = (body.mass_kg - 2.473) / moving_kg;
  const double kappa = 0.5 * 1000.0 * body.frontal_area_m2 * 0.9 / moving_kg;
  const auto truth = drop(alpha, kappa, 6.0);
  const std::size_t from = 620, rows = truth.touchdown - 20 - from;
  const auto fit = fit_fluid(std::span(truth.speed_mps).subspan(from, rows),
                             std::span(truth.specific_force_mps2).subspan(from, rows), kGravity);
  EXPECT_NEAR(fit.alpha, alpha, 1e-3);
  EXPECT_NEAR(fit.kappa_per_m, kappa, 1e-3);
  EXPECT_NEAR(coefficients(fit, body).added_mass_factor, 0.4, 0.02);
  EXPECT_NEAR(coefficients(fit, body).drag_coefficient, 0.9, 0.01);
  EXPECT_TRUE(std::isnan(fit_fluid({}, {}, kGravity).alpha));
}

TEST(AccelerometerFusion, QuietSensorSpeaksUntilItSaturates) {
  const auto truth = drop(0.7, 0.33, 20.0).specific_force_mps2;
  auto fine = noisy(truth, 0.02, 3), coarse = noisy(truth, 0.2, 4), middle = noisy(truth, 0.1, 5);
  for (double& f : fine) f = std::min((f - 0.3) / 1.02, 19.6);
  for (double& f : coarse) f = f + 0.7;
  const std::array<std::span<const double>, 3> channels{fine, middle, coarse};
  const auto fused = fuse_accelerometers(channels, {});
  EXPECT_EQ(fused.reference, 1u);
  EXPECT_GT(fused.calibration[0].saturated_samples, 50u);
  EXPECT_NEAR(fused.calibration[0].scale, 1.02, 5e-3);
  EXPECT_NEAR(fused.calibration[0].bias_mps2, 0.3, 0.05);
  EXPECT_NEAR(fused.calibration[2].bias_mps2, -0.7, 0.05);
  const auto peak = static_cast<std::size_t>(std::max_element(truth.begin(), truth.end()) - truth.begin());
  EXPECT_EQ(fused.source[peak], 1u);
  EXPECT_EQ(fused.source[100], 0u);
  EXPECT_NEAR(fused.specific_force_mps2[peak], truth[peak], 0.5);
  for (double& f : middle) f = std::min(f, 19.0);
  for (double& f : coarse) f = std::min(f, 19.0);
  EXPECT_THROW(fuse_accelerometers(channels, {}), std::invalid_argument);
}

TEST(ResistanceLaw, ExponentAndRateComeBackFromDropsOfDifferentStrength) {
  std::vector<Penetration> drops;
  for (const double strength : {5.0, 8.0, 6.0}) {
    Penetration p;
    for (int i = 1; i <= 200; ++i) {
      const double z = 0.5 * i / 200.0, v = (4.0 + 0.1 * strength) * std::sqrt(1.001 - z / 0.5);
      p.push_back({z, v, resistance(ResistanceLaw::depth_power_rate, 1.4, 0.15, strength, z, v)});
    }
    drops.push_back(p);
  }
  const auto fit = fit_resistance(ResistanceLaw::depth_power_rate, drops);
  EXPECT_NEAR(fit.exponent, 1.4, 0.01);
  EXPECT_NEAR(fit.rate, 0.15, 0.01);
  EXPECT_NEAR(fit.strength[1], 8.0, 0.05);
  EXPECT_GT(fit_resistance(ResistanceLaw::depth, drops).rms, 10.0 * fit.rms);
  EXPECT_LT(cross_validate(ResistanceLaw::depth_power_rate, drops)[0], 1e-3);
  EXPECT_LT(depth_speed_correlation(drops[0]), -0.5);
}

}  // namespace
}  // namespace sandhopper
