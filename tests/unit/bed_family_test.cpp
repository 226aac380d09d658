#include "terrain/bed_family.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "config/load.hpp"
#include "terrain/bed.hpp"
#include "tools/plant/bed_truth.hpp"
#include "tools/plant/load_world.hpp"
#include "tools/plant/plant.hpp"
#include "tools/plant/random.hpp"
#include "tools/plant/trial_draw.hpp"
#include "tools/plant/world.hpp"

namespace sandhopper {
namespace {

constexpr double kRadius_m = 0.040;
constexpr double kArea_m2 = std::numbers::pi * kRadius_m * kRadius_m;

std::vector<BedFamily> all_families() {
  std::vector<BedFamily> families;
  for (std::size_t i = 0; i < EnumNames<BedFamily>::value.size(); ++i)
    families.push_back(static_cast<BedFamily>(i));
  return families;
}

Bed bed_of(BedFamily family, const BedFluctuation& fluctuation = {}) {
  return {BedParameters{}, kRadius_m, fluctuation, bed_family_of(family)};
}

double tangent_N_per_m(const Bed& bed, double depth_m) {
  constexpr double h = 1e-6;
  return (bed.quasi_static_force_N(depth_m + h) - bed.quasi_static_force_N(depth_m - h)) / (2 * h);
}

// The plain bed's law from the header, implemented a second time.
double plain_force_N(const BedParameters& p, double z, double v, double z_max, double mass_kg, double accel) {
  const double line = p.unloading_stiffness_ratio * p.stiffness_N_per_m;
  const auto curve = [&](double depth) {
    return p.stiffness_N_per_m *
           (depth + p.intercept_depth_m * (1.0 - std::exp(-depth / p.intercept_growth_depth_m)));
  };
  if (z <= 0.0) return 0.0;
  if (z >= z_max && v > 0.0) {
    const double slope =
        p.added_mass_recruitment / std::tan(p.added_mass_band_angle_deg * std::numbers::pi / 180.0);
    const double scale =
        p.added_mass_factor * p.bulk_density_kg_per_m3 * p.added_mass_recruitment * std::numbers::pi;
    const double flat = std::max(0.0, kRadius_m - slope * z);
    const double mass = scale / (3.0 * slope) * (kRadius_m * (kRadius_m * kRadius_m) - flat * (flat * flat));
    const double drag = p.drag_factor * (scale * (flat * flat)) +
                        p.steady_drag_coefficient * p.bulk_density_kg_per_m3 * kArea_m2;
    const double engaged = std::min(1.0, v / p.added_mass_switch_speed_mps);
    return std::max(0.0, curve(z) + drag * (v * v) - engaged * mass * accel);
  }
  const double elastic = curve(z_max) - line * (z_max - z);
  if (elastic <= 0.0) return 0.0;
  return std::max(0.0, elastic + 2.0 * p.unloading_damping_ratio * std::sqrt(line * mass_kg) * v *
                                     std::min(1.0, elastic / 5.0));
}

TEST(BedFamily, TheDefaultBedKeepsItsBits) {
  const BedParameters p;
  const Bed bed(p, kRadius_m);
  Random random(3, 0);
  for (int i = 0; i < 20000; ++i) {
    const double z_max = 0.08 * random.uniform();
    const double z = i % 2 == 0 ? z_max : z_max + 2e-3 * random.normal();
    const double v = random.normal(), accel = 30.0 * random.normal();
    ASSERT_EQ(bed.reaction({z, v, z_max, 0.65}).at_acceleration(accel),
              plain_force_N(p, z, v, z_max, 0.65, accel));
  }
}

TEST(BedFamily, ForceIsContinuousAndStartsAtZero) {
  for (const auto family : all_families()) {
    const Bed bed = bed_of(family);
    EXPECT_NEAR(bed.quasi_static_force_N(1e-9), 0.0, 1e-3) << name_of(family);
    constexpr double step = 1e-6;
    for (double z = step; z < 0.1; z += step) {
      const double change = bed.quasi_static_force_N(z + step) - bed.quasi_static_force_N(z);
      // Limit per micrometre: a brittle crust of 30 N breaks over half a millimetre.
      ASSERT_LT(std::abs(change), 0.1) << name_of(family) << " at " << z;
      ASSERT_GT(bed.quasi_static_force_N(z), 0.0) << name_of(family);
    }
  }
}

TEST(BedFamily, UnloadsAndReloadsOnItsStiffLineUpToTheDeepestPointAndGoesOnOnTheVirginCurve) {
  for (const auto family : all_families()) {
    const Bed bed = bed_of(family);
    for (const double z_max : {0.011, 0.0117, 0.0145, 0.020, 0.030, 0.045}) {
      const double full = bed.quasi_static_force_N(z_max);
      const double line = bed.unloading_line_N_per_m();
      const double floor = bed.crater_floor_m(z_max);
      EXPECT_NEAR(floor, z_max - full / line, 1e-12) << name_of(family);
      for (const double share : {0.25, 0.5, 0.9}) {
        const double z = floor + share * (z_max - floor);
        EXPECT_NEAR(bed.reaction({z, 1e-9, z_max, 0.65}).force_N, share * full, 1e-6) << name_of(family);
        EXPECT_NEAR(bed.reaction({z, -1e-9, z_max, 0.65}).force_N, share * full, 1e-6) << name_of(family);
      }
      EXPECT_EQ(bed.reaction({floor - 1e-5, 0.5, z_max, 0.65}).force_N, 0.0) << name_of(family);
      EXPECT_NEAR(bed.reaction({z_max, 1e-9, z_max, 0.65}).force_N, full, 1e-6) << name_of(family);
      const double deeper = z_max + 1e-3;
      EXPECT_NEAR(bed.reaction({deeper, 1e-9, z_max, 0.65}).force_N, bed.quasi_static_force_N(deeper), 1e-6)
          << name_of(family);
    }
  }
}

TEST(BedFamily, GivesBackLessWorkThanItTook) {
  for (const auto family : all_families()) {
    const Bed bed = bed_of(family);
    EXPECT_LT(bed.greatest_stiffness_N_per_m(0.1), bed.unloading_line_N_per_m()) << name_of(family);
  }
}

TEST(BedFamily, PowerLawMeetsTheLineAtItsReferenceDepth) {
  BedFamilyParameters p = bed_family_of(BedFamily::power_law);
  const double reference_N = Bed({}, kRadius_m).quasi_static_force_N(p.reference_depth_m);
  for (const double n : {0.8, 1.0, 1.4, 1.8}) {
    p.exponent = n;
    const Bed bed({}, kRadius_m, {}, p);
    EXPECT_NEAR(bed.quasi_static_force_N(0.030), reference_N, 1e-9);
    EXPECT_NEAR(bed.quasi_static_force_N(0.060) / reference_N, std::pow(2.0, n), 1e-9);
    EXPECT_NEAR(bed.quasi_static_force_N(0.010) / reference_N, std::pow(3.0, -n), 1e-9);
  }
}

TEST(BedFamily, LayersHaveTheStiffnessOfTheirMaterialAwayFromTheBoundary) {
  const Bed plain({}, kRadius_m);
  const Bed soft_first = bed_of(BedFamily::soft_over_stiff);
  const Bed stiff_first = bed_of(BedFamily::stiff_over_soft);
  const auto relative = [&](const Bed& bed, double z) {
    return bed.quasi_static_force_N(z) / plain.quasi_static_force_N(z);
  };
  EXPECT_NEAR(relative(soft_first, 0.006), 1000.0 / 1500.0, 0.003);
  EXPECT_NEAR(relative(soft_first, 0.050), 3600.0 / 1500.0, 0.003);
  EXPECT_NEAR(relative(stiff_first, 0.002), 2400.0 / 1500.0, 0.003);
  EXPECT_NEAR(relative(stiff_first, 0.050), 1000.0 / 1500.0, 0.003);
  EXPECT_LT(stiff_first.quasi_static_force_N(0.021), 0.85 * stiff_first.quasi_static_force_N(0.0115));
}

TEST(BedFamily, CrustBreaksOnceAtItsDepthUnderItsForce) {
  const auto p = bed_family_of(BedFamily::crust);
  const Bed bed = bed_of(BedFamily::crust), without({}, kRadius_m);
  const double rupture_N = 2.0 * std::numbers::pi * kRadius_m * 0.003 * 40e3;
  EXPECT_NEAR(rupture_N, 30.0, 0.2);
  const auto crust_N = [&](double z) {
    return bed.quasi_static_force_N(z) - without.quasi_static_force_N(z);
  };
  EXPECT_EQ(crust_N(0.5 * p.crust_depth_m), 0.0);
  EXPECT_NEAR(crust_N(p.rupture_depth_m()), rupture_N, 1e-9);
  EXPECT_NEAR(crust_N(p.rupture_depth_m() + p.crust_breakage_length_m), rupture_N / std::numbers::e, 1e-9);
  EXPECT_LT(crust_N(p.rupture_depth_m() + 0.005), 0.01);
  // In the crater of a broken crust a later stride must not meet the crust again.
  EXPECT_EQ(bed.reaction({p.rupture_depth_m(), 0.5, 0.030, 0.65}).force_N, 0.0);
}

TEST(BedFamily, WetBedPullsOnlyAFootThatLeavesTheFloorOfItsCrater) {
  const auto p = bed_family_of(BedFamily::wet);
  const Bed bed = bed_of(BedFamily::wet);
  const double z_max = 0.030, floor = bed.crater_floor_m(z_max), peak = floor - p.suction_distance_m / 3.0;
  EXPECT_NEAR(bed.reaction({peak, -0.1, z_max, 0.65}).at_acceleration(0.0), -p.suction_Pa * kArea_m2, 1e-9);
  EXPECT_EQ(bed.reaction({peak, 0.1, z_max, 0.65}).at_acceleration(0.0), 0.0);
  EXPECT_EQ(bed.reaction({floor - 1.01 * p.suction_distance_m, -0.1, z_max, 0.65}).force_N, 0.0);
  for (double z = 0.0; z < z_max; z += 1e-5) {  // no jump of the force while the foot leaves
    const double change =
        bed.reaction({z + 1e-5, -1e-3, z_max, 0.0}).force_N - bed.reaction({z, -1e-3, z_max, 0.0}).force_N;
    ASSERT_LT(std::abs(change), 0.6) << z;
  }
  EXPECT_NEAR(bed.reaction({1e-6, -0.1, 0.004, 0.65}).force_N, 0.0,
              0.01);  // a shallow crater ends at the surface
  EXPECT_GE(bed.reaction({0.02, -0.1, 0.02, 0.65}).least_N, 0.0);
}

TEST(BedFamily, CompactedAndDenserBedsAreStiffer) {
  EXPECT_NEAR(tangent_N_per_m(bed_of(BedFamily::compacted), 0.04), 3600.0, 1.0);
  const Bed denser = bed_of(BedFamily::gradually_denser);
  EXPECT_GT(tangent_N_per_m(denser, 0.040), 1.5 * tangent_N_per_m(denser, 0.010));
}

TEST(BedFamily, FloorOfTheBoxStopsTheFoot) {
  BedFamilyParameters p;
  p.floor_depth_m = 0.030;
  const Bed boxed({}, kRadius_m, {}, p), open({}, kRadius_m);
  EXPECT_EQ(boxed.quasi_static_force_N(0.030), open.quasi_static_force_N(0.030));
  EXPECT_NEAR(boxed.quasi_static_force_N(0.032) - open.quasi_static_force_N(0.032), 80.0, 1e-9);
}

// The plant's memory of the deepest point, in every family: a foot falls, stands and is lifted.
TEST(BedFamily, StridesInTheCraterStartAtItsFloor) {
  for (const auto family : all_families()) {
    WorldConfig config;
    config.bed_family = bed_family_of(family);
    const Bed bed(config.terrain, config.robot.leg.foot_radius_m, {}, config.bed_family);
    Plant plant(config, bed);
    plant.place({.foot_z_m = 0.03, .angle_rad = plant.leg().angle_at_length(0.30)});
    for (int i = 0; i < 4000 && plant.state().foot_velocity_mps <= 0.0; ++i) plant.step(0.0);
    const double crater = plant.max_depth_m();
    ASSERT_GT(crater, 0.005) << name_of(family);
    PlantState again = plant.state();
    again.foot_z_m = 0.0;
    again.foot_velocity_mps = -0.5;
    plant.place_in_crater(again, crater);
    double first_force_m = 0.0;
    for (int i = 0; i < 4000 && first_force_m == 0.0; ++i) {
      plant.step(0.0);
      if (plant.motion(0.0).contact_force_N > 0.0) first_force_m = -plant.state().foot_z_m;
    }
    EXPECT_NEAR(first_force_m, bed.crater_floor_m(crater), 2e-4) << name_of(family);
  }
}

TEST(BedFamily, TrialsDifferByTheStatedSpread) {
  WorldConfig config;
  config.bed_family = bed_family_of(BedFamily::crust);
  double sum = 0.0, squares = 0.0;
  constexpr int kTrials = 400;
  for (int seed = 1; seed <= kTrials; ++seed) {
    const TrialDraw draw(config, {.seed = static_cast<std::uint64_t>(seed), .noise = true, .start_ns = 0});
    const double off = draw.bed().family().crust_depth_m - config.bed_family.crust_depth_m;
    sum += off;
    squares += off * off;
  }
  EXPECT_NEAR(sum / kTrials, 0.0, 4e-4);
  EXPECT_NEAR(std::sqrt(squares / kTrials), config.bed_family.depth_spread_m, 2e-4);
  const TrialDraw quiet(config, {.seed = 1, .noise = false, .start_ns = 0});
  EXPECT_EQ(quiet.bed().family().crust_depth_m, config.bed_family.crust_depth_m);
}

class WorldFile : public ::testing::Test {
 protected:
  WorldConfig load(const std::string& text) {
    std::ofstream(path_) << text;
    return load_world_file(path_, WorldConfig{});
  }
  void TearDown() override { std::filesystem::remove(path_); }
  const std::filesystem::path path_ =
      std::filesystem::temp_directory_path() / ("world_" + std::to_string(::getpid()) + ".toml");
};

TEST_F(WorldFile, NamesAFamilyWhichGivesTheOtherKeysTheirValues) {
  const auto crust = load("[bed_family]\nfamily = \"crust\"\ncrust_depth_m = 0.015\n").bed_family;
  EXPECT_EQ(crust.crust_shear_strength_Pa, 40e3);
  EXPECT_EQ(crust.crust_depth_m, 0.015);
  EXPECT_EQ(load("").bed_family.family, BedFamily::line);
  const auto whole = load("[bed_family]\nfamily = \"wet\"\n");
  EXPECT_EQ(to_toml(load(to_toml(whole))), to_toml(whole));
}

TEST_F(WorldFile, RefusesAFamilyThatIsNoneAndABedThatGivesBackMoreThanItTook) {
  EXPECT_THROW(load("[bed_family]\nfamily = \"mud\"\n"), ConfigError);
  EXPECT_THROW(load("[bed_family]\nfamily = \"crust\"\ncrust_deflection_m = 0.0002\n"), ConfigError);
}

TEST(BedTruth, ReadsBackTheTrialsOwnCurve) {
  for (const auto family : all_families()) {
    WorldConfig config;
    config.bed_family = bed_family_of(family);
    const TrialDraw draw(config, {.seed = 5, .noise = true, .start_ns = 0});
    const Bed bed = draw.bed();
    const auto truth = read_bed_truth(bed_truth_text(bed));
    EXPECT_EQ(truth.family, name_of(family));
    EXPECT_EQ(truth.rupture_depth_m.has_value(), family == BedFamily::crust);
    EXPECT_EQ(truth.boundary_depth_m.has_value(),
              family == BedFamily::soft_over_stiff || family == BedFamily::stiff_over_soft);
    EXPECT_EQ(truth.suction_N.has_value(), family == BedFamily::wet);
    EXPECT_EQ(truth.force_at_N(0.020), bed.quasi_static_force_N(0.020));
    EXPECT_NEAR(truth.force_at_N(0.02075), bed.quasi_static_force_N(0.02075), 1.0);
    EXPECT_TRUE(std::isnan(truth.force_at_N(0.2)));
  }
  EXPECT_THROW(read_bed_truth("{}"), std::runtime_error);
}

}  // namespace
}  // namespace sandhopper
