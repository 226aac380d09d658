#include "tools/terrain/stroke_map.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "campaign_folder.hpp"
#include "tools/plant/random.hpp"
#include "tools/terrain/campaign_analysis.hpp"
#include "tools/trial/campaign_maker.hpp"

namespace sandhopper {
namespace {

constexpr double kStiffness_N_per_m = 1500.0, kIntercept_N = 2.0;
constexpr std::array<double, 3> kDrag{14.0, -600.0, 6000.0};

// A stroke that starts with `speed_mps` and slows down towards its end, with noise of `noise_N`.
StrokeSums stroke(double speed_mps, double noise_N, std::uint64_t seed) {
  Random random(seed, 1);
  StrokeSums sums;
  for (int i = 0; i < 200; ++i) {
    const double z = 0.00022 * i;
    const double v = speed_mps * std::sqrt(std::max(0.05, 1.0 - std::pow(z / 0.044, 4)));
    const double a = z > 0.02 ? -20.0 * speed_mps * z / 0.044 : 0.0;
    const double m = z * (kDrag[0] + z * (kDrag[1] / 2 + z * kDrag[2] / 3));
    const double drag = kDrag[0] + z * (kDrag[1] + z * kDrag[2]);
    sums.add(
        {z, v, a, kIntercept_N + kStiffness_N_per_m * z + drag * v * v + m * a + noise_N * random.normal()});
  }
  return sums;
}

std::vector<StrokeSums> strokes(double noise_N) {
  std::vector<StrokeSums> all;
  for (const double speed : {0.05, 0.3, 0.6, 0.8, 1.0, 1.1})
    all.push_back(stroke(speed, noise_N, all.size() + 1));
  return all;
}

TEST(StrokeMap, FindsStiffnessDragAndAddedMass) {
  const auto fit = fit_stroke_map(strokes(0.5), StrokeTerms::with_added_mass);
  EXPECT_NEAR(fit.map.stiffness_N_per_m, kStiffness_N_per_m, 30.0);
  EXPECT_NEAR(fit.map.drag_kg_per_m(0.0), kDrag[0], 1.0);
  EXPECT_NEAR(fit.map.added_mass_kg(0.03), 0.03 * (14.0 - 9.0 + 1.8), 0.01);
  EXPECT_LT(fit.stiffness_N_per_m.ci95_low, kStiffness_N_per_m);
  EXPECT_GT(fit.stiffness_N_per_m.ci95_high, kStiffness_N_per_m);
  EXPECT_EQ(fit.stiffness_N_per_m.trials, 6U);
}

TEST(StrokeMap, WithoutAccelerationTheInertiaStaysInTheResidual) {
  const auto all = strokes(0.2);
  const auto map = fit_stroke_map(all, StrokeTerms::with_added_mass).map;
  const auto left = stroke_residuals(all.back(), map);
  EXPECT_NEAR(left.added_mass_rms_N, 0.2, 0.1);
  EXPECT_GT(left.map_rms_N, 3.0 * left.added_mass_rms_N);
  EXPECT_GT(left.correlation, 0.9);
}

TEST(StrokeMap, SaysNothingWhereSpeedNeverDiffers) {
  StrokeSums still;
  for (int i = 0; i < 50; ++i) still.add({1e-3 * i, 0.0, 0.0, 1.5 * i});
  EXPECT_TRUE(std::isnan(fit_stroke_map(still, StrokeTerms::depth_and_speed).stiffness_N_per_m));
}

TEST(StrokeMap, SumsTravelAsNumbers) {
  const auto sums = stroke(1.0, 0.1, 3);
  const auto back = StrokeSums::from(sums.numbers());
  EXPECT_EQ(back.numbers(), sums.numbers());
  EXPECT_EQ(back.samples(), 200.0);
  EXPECT_EQ(StrokeSums::from(std::vector<double>{1.0}).samples(), 0.0);
}

// Simulated strokes without a recorded speed must give the bed's stiffness, its added mass, and the area law.
TEST(TerrainStrokes, ASimulatedCampaignTellsItsBed) {
  CampaignFolder folder;
  CampaignMakerSetup setup;
  setup.folder = folder.path();
  setup.trials = 20;
  make_intrusion_campaign(setup);
  const auto report = report_on(analyse_campaign(load_campaign(folder.path()), {}));
  const auto& strokes = report.json.at("conclusions").at("strokes");
  EXPECT_EQ(strokes.at("speed_from_camera_and_accelerometer").get<int>(), 20);
  const auto& plate = strokes.at("plates").at(0);
  EXPECT_EQ(plate.at("plate_diameter_m").get<double>(), 0.08);
  EXPECT_NEAR(plate.at("stiffness_N_per_m").at("value").get<double>(), 1525.0, 60.0);
  const double added_mass_kg = 0.168;  // of the fully grown cone, at 34.6 mm
  EXPECT_NEAR(plate.at("added_mass_at_30mm_kg").at("value").get<double>() / added_mass_kg, 1.0, 0.2);
  const auto& fast = plate.at("fast_strokes");
  EXPECT_LT(fast.at("map_and_added_mass_rms_N").get<double>(), 0.7 * fast.at("map_rms_N").get<double>());
  EXPECT_GT(fast.at("correlation").get<double>(), 0.7);
  EXPECT_NEAR(strokes.at("area_exponent").at("value").get<double>(), 1.0, 0.1);
  EXPECT_GT(
      report.json.at("pooled").at("intrusion").at("unloading_stiffness_N_per_m").at("value").get<double>(),
      15000.0);
}

}  // namespace
}  // namespace sandhopper
