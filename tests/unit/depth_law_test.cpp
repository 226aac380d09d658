#include "terrain/depth_law.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "terrain/series_compliance.hpp"
#include "terrain/trial_statistics.hpp"

namespace sandhopper {
namespace {

constexpr DepthLaw kLaws[] = {DepthLaw::linear, DepthLaw::power, DepthLaw::cone, DepthLaw::floor_stiffening,
                              DepthLaw::confined_layer};

double true_shape(DepthLaw law) {
  switch (law) {
    case DepthLaw::power:
      return 1.3;
    case DepthLaw::cone:
      return 0.15;
    case DepthLaw::floor_stiffening:
      return 0.045;
    case DepthLaw::confined_layer:
      return 0.07;
    case DepthLaw::linear:
      break;
  }
  return 0.0;
}

DepthTrial press(const DepthLawFit& truth, double diameter_m, double deepest_m, double noise_N,
                 const DepthLawOptions& options, unsigned seed) {
  std::mt19937_64 rng(seed);
  std::normal_distribution<double> normal;
  DepthTrial trial{diameter_m, {}};
  for (int i = 1; i <= 200; ++i) {
    const double z = deepest_m * i / 200;
    trial.samples.push_back({z, depth_law_force_N(truth, z, diameter_m, options) + noise_N * normal(rng)});
  }
  return trial;
}

TEST(DepthLaw, EachLawIsFoundFromOnePlateAndPredictsTheOther) {
  const DepthLawOptions options{};
  for (const auto law : kLaws) {
    const DepthLawFit truth{law, 700e3, true_shape(law), 0.0};
    std::vector<DepthTrial> trials;
    for (unsigned seed = 0; seed < 3; ++seed) trials.push_back(press(truth, 0.06, 0.035, 0.3, options, seed));
    const auto fit = fit_depth_law(law, trials, options);
    EXPECT_NEAR(fit.stiffness_per_area_N_per_m3 / 700e3, 1.0, 0.01) << name_of(law);
    if (law != DepthLaw::linear) {
      EXPECT_NEAR(fit.shape / truth.shape, 1.0, 0.02) << name_of(law);
    }
    EXPECT_NEAR(fit.rms_N, 0.3, 0.03) << name_of(law);
    EXPECT_NEAR(depth_law_force_N(fit, 0.02, 0.08, options) / depth_law_force_N(truth, 0.02, 0.08, options),
                1.0, 0.01)
        << name_of(law);
  }
}

TEST(DepthLaw, CrossValidationPrefersTheLawThatMadeTheData) {
  const DepthLawOptions options{};
  const DepthLawFit truth{DepthLaw::confined_layer, 700e3, 0.06, 0.0};
  std::vector<DepthTrial> trials;
  for (unsigned seed = 0; seed < 3; ++seed) trials.push_back(press(truth, 0.06, 0.035, 0.3, options, seed));
  const auto worst_of = [&](DepthLaw law) {
    const auto rms = cross_validate(law, trials, options);
    return *std::max_element(rms.begin(), rms.end());
  };
  for (const auto law : kLaws)
    if (law != DepthLaw::confined_layer) {
      EXPECT_GT(worst_of(law), worst_of(DepthLaw::confined_layer)) << name_of(law);
    }
}

TEST(DepthLaw, ConfinedLayerFarFromItsFloorIsLinear) {
  const DepthLawFit deep{DepthLaw::confined_layer, 1e6, 50.0, 0.0};
  const double area_m2 = std::numbers::pi * 0.03 * 0.03;
  EXPECT_NEAR(depth_law_force_N(deep, 0.02, 0.06, {}), 1e6 * area_m2 * 0.02, 0.05);
  EXPECT_TRUE(std::isinf(depth_law_force_N({DepthLaw::confined_layer, 1e6, 0.02, 0.0}, 0.021, 0.06, {})));
}

TEST(DepthLaw, ComplianceIsTakenOffTheRecordedDepth) {
  const DepthLawOptions rig{.compliance_m_per_N = 12e-6};
  const DepthLawFit truth{DepthLaw::power, 700e3, 1.2, 0.0};
  const double force_N = depth_law_force_N(truth, 0.02, 0.08, rig);
  EXPECT_NEAR(force_N, depth_law_force_N(truth, 0.02 - 12e-6 * force_N, 0.08, {}), 1e-6);
  const std::vector trials{press(truth, 0.06, 0.03, 0.0, rig, 1)};
  EXPECT_NEAR(fit_depth_law(DepthLaw::power, trials, rig).shape, 1.2, 1e-4);
  EXPECT_GT(std::abs(fit_depth_law(DepthLaw::power, trials, {}).shape - 1.2), 1e-3);
}

TEST(DepthLaw, TooLittleToFitIsNotANumber) {
  EXPECT_TRUE(std::isnan(fit_depth_law(DepthLaw::power, {}, {}).shape));
  const std::vector<DepthTrial> two{{0.06, {{0.01, 1.0}, {0.02, 2.0}}}};
  EXPECT_TRUE(std::isnan(fit_depth_law(DepthLaw::power, two, {}).stiffness_per_area_N_per_m3));
  EXPECT_TRUE(std::isnan(measured_force_N(two[0], 0.015)));
}

TEST(SeriesCompliance, StopGivesSlopeToeAndRecovery) {
  std::vector<double> z, f;
  for (int i = 0; i <= 300; ++i) {  // 0.4 mm of play that closes below 15 N, then 12 um/N
    f.push_back(i);
    z.push_back(0.048 + 12e-6 * i + 0.4e-3 * (1.0 - std::exp(-i / 15.0)));
  }
  for (int i = 300; i >= 30; --i) {
    f.push_back(i);
    z.push_back(0.048 + 12e-6 * i + 0.4e-3);
  }
  const auto loading = loading_compliance({z, f}, 0.5);
  EXPECT_NEAR(loading.compliance_m_per_N, 12e-6, 0.1e-6);
  EXPECT_NEAR(loading.toe_m, 0.4e-3, 0.05e-3);
  EXPECT_NEAR(unloading({z, f}, 1e-5).stiffness_N_per_m, 1.0 / 12e-6, 500.0);
  EXPECT_TRUE(
      std::isnan(unloading({std::span(z).first(301), std::span(f).first(301)}, 1e-5).stiffness_N_per_m));
}

TEST(TrialStatistics, IntervalCountsTrials) {
  const std::vector<double> three{1.0, 2.0, 3.0};
  const auto mean = mean_over_trials(three);
  EXPECT_DOUBLE_EQ(mean.value, 2.0);
  EXPECT_NEAR(mean.ci95_high - mean.value, 4.3027 / std::sqrt(3.0), 1e-4);
  EXPECT_TRUE(std::isinf(mean_over_trials(std::span(three).first(1)).ci95_high));
  EXPECT_NEAR(student_t95(10), 2.2281, 1e-4);
  EXPECT_NEAR(student_t95(30), 2.0423, 1e-4);
}

}  // namespace
}  // namespace sandhopper
