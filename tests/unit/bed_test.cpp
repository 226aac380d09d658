#include "terrain/bed.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tools/plant/random.hpp"

namespace sandhopper {
namespace {

constexpr double kRadius_m = 0.040;

// Tracks the deepest point as the plant does, for motions at a given speed.
class Pushed {
 public:
  explicit Pushed(const Bed& bed, double damping_mass_kg = 0.0)
      : bed_(bed), damping_mass_kg_(damping_mass_kg) {}
  double force_N(double depth_m, double speed_mps, double foot_accel_mps2 = 0.0) {
    const double force =
        bed_.reaction({depth_m, speed_mps, max_depth_m_, damping_mass_kg_}).at_acceleration(foot_accel_mps2);
    max_depth_m_ = std::max(max_depth_m_, depth_m);
    return force;
  }
  double max_depth_m() const { return max_depth_m_; }

 private:
  const Bed& bed_;
  double damping_mass_kg_;
  double max_depth_m_ = 0.0;
};

TEST(Bed, AddedMassAndItsGradientFollowThePrintedTable) {
  const Bed bed({}, kRadius_m);
  struct Row {
    double depth_mm, mass_g, gradient_kg_per_m;
  };
  for (const auto& row : {Row{0, 0, 14.58}, Row{5, 63, 10.67}, Row{10, 108, 7.38}, Row{20, 156, 2.60},
                          Row{30, 168, .26}, Row{34.641, 168, 0}, Row{50, 168, 0}}) {
    EXPECT_NEAR(1e3 * bed.added_mass_kg(1e-3 * row.depth_mm), row.mass_g, 0.5) << row.depth_mm << " mm";
    EXPECT_NEAR(bed.added_mass_gradient_kg_per_m(1e-3 * row.depth_mm), row.gradient_kg_per_m, 0.005)
        << row.depth_mm << " mm";
  }
  BedParameters surrounded;
  surrounded.added_mass_factor = 2.7;
  EXPECT_NEAR(Bed(surrounded, kRadius_m).added_mass_kg(0.05), 0.454, 5e-4);
}

TEST(Bed, DragIsTheGradientOfTheAddedMass) {
  const Bed bed({}, kRadius_m);
  const double h = 1e-7;
  for (double z = 0.001; z < 0.034; z += 0.003)
    EXPECT_NEAR((bed.added_mass_kg(z + h) - bed.added_mass_kg(z - h)) / (2 * h),
                bed.added_mass_gradient_kg_per_m(z), 1e-6);
  const double v = 0.8, z = 0.012;
  const double drag = bed.reaction({z, v, z, 0.0}).force_N - bed.quasi_static_force_N(z);
  EXPECT_NEAR(drag, bed.added_mass_gradient_kg_per_m(z) * v * v, 1e-12);
}

TEST(Bed, DeepSlopeIsTheStiffnessAndTheInterceptThatOfTheCone) {
  const Bed bed({}, kRadius_m);
  EXPECT_EQ(bed.quasi_static_force_N(0.0), 0.0);
  EXPECT_NEAR(bed.quasi_static_force_N(0.050) - bed.quasi_static_force_N(0.040), 15.0, 1e-4);
  EXPECT_NEAR(bed.quasi_static_force_N(0.050), 1500.0 * 0.053, 1e-5);
}

TEST(Bed, AnsweringAccelerationLowersTheForceByTheAddedMass) {
  const Bed bed({}, kRadius_m);
  const auto ground = bed.reaction({0.02, 0.5, 0.02, 0.0});
  EXPECT_NEAR(ground.at_acceleration(0.0) - ground.at_acceleration(10.0), 10.0 * bed.added_mass_kg(0.02),
              1e-12);
  EXPECT_EQ(ground.at_acceleration(1e4), 0.0);  // the bed cannot pull
}

TEST(Bed, ForceIsContinuousWhereTheFootTouchesAndWhereItTurns) {
  const Bed bed({}, kRadius_m);
  EXPECT_NEAR(bed.reaction({1e-9, 0.2, 0.0, 0.6}).force_N, bed.added_mass_gradient_kg_per_m(0) * 0.04, 1e-5);
  const double z = 0.03;
  const double stopping = bed.reaction({z, 1e-9, z, 0.6}).at_acceleration(20.0);
  const double leaving = bed.reaction({z, -1e-9, z, 0.6}).at_acceleration(20.0);
  EXPECT_NEAR(stopping, leaving, 1e-5);
}

TEST(Bed, UnloadingFollowsTheSteepLineToTheCraterFloorAndReloadsOnIt) {
  const Bed bed({}, kRadius_m);
  const double z_max = 0.03;
  const double full = bed.quasi_static_force_N(z_max);
  Pushed foot(bed);
  for (double z = 0.0; z <= z_max + 1e-12; z += 1e-4) foot.force_N(z, 1e-6);
  EXPECT_NEAR(bed.crater_floor_m(z_max), z_max - full / 45000.0, 1e-12);
  const double half = (z_max + bed.crater_floor_m(z_max)) / 2;
  EXPECT_NEAR(foot.force_N(half, -0.01), full / 2, 1e-6);
  EXPECT_NEAR(foot.force_N(half, 0.01), full / 2, 1e-6);
  EXPECT_EQ(foot.force_N(bed.crater_floor_m(z_max) - 1e-6, 0.01), 0.0);
  EXPECT_EQ(foot.force_N(0.001, 0.5), 0.0);  // a later stride falls through the crater
}

TEST(Bed, ACycleDissipatesAllButTheElasticWork) {
  const Bed bed({}, kRadius_m);
  Pushed foot(bed);
  const double dz = 1e-6, z_max = 0.03;
  double work_J = 0.0;
  for (double z = dz / 2; z < z_max; z += dz) work_J += foot.force_N(z, 1e-6) * dz;
  const double deepest = foot.max_depth_m();
  double returned_J = 0.0;
  for (double z = deepest; z > 0.02; z -= dz) returned_J += foot.force_N(z, -1e-6) * dz;
  const double full = bed.quasi_static_force_N(deepest);
  EXPECT_NEAR(returned_J, full * full / (2.0 * 45000.0), 1e-4);
  EXPECT_GT(work_J - returned_J, 0.9 * work_J);
}

TEST(Bed, NeverPulls) {
  BedParameters p;
  p.added_mass_factor = 2.7;
  p.steady_drag_coefficient = 1.0;
  const Bed bed(p, kRadius_m);
  Random random(1, 0);
  for (int i = 0; i < 20000; ++i) {
    const double z_max = 0.08 * random.uniform();
    const double z = 0.1 * random.uniform() - 0.01;
    const auto ground = bed.reaction({z, 3.0 * random.normal(), z_max, 0.7});
    const double force = ground.at_acceleration(100.0 * random.normal());
    ASSERT_GE(force, 0.0);
    ASSERT_GE(ground.added_mass_kg, 0.0);
    if (z <= 0.0) {
      ASSERT_EQ(force, 0.0);
    }
  }
}

TEST(Bed, DampingOpposesTheFootOnTheUnloadingLine) {
  const Bed bed({}, kRadius_m);
  const BedContact still{.depth_m = 0.0299, .speed_mps = 0.0, .max_depth_m = 0.03, .damping_mass_kg = 0.65};
  BedContact down = still, up = still;
  down.speed_mps = 0.05;
  up.speed_mps = -0.05;
  const double c = 2.0 * 0.6 * std::sqrt(45000.0 * 0.65);
  EXPECT_NEAR(bed.reaction(down).force_N - bed.reaction(still).force_N, 0.05 * c, 1e-9);
  EXPECT_NEAR(bed.reaction(still).force_N - bed.reaction(up).force_N, 0.05 * c, 1e-9);
}

TEST(Bed, SwitchesRemoveTheirTermsOnly) {
  BedParameters none;
  none.added_mass_factor = 0.0;
  const auto bare = Bed(none, kRadius_m).reaction({0.01, 1.0, 0.01, 0.0});
  EXPECT_EQ(bare.added_mass_kg, 0.0);
  EXPECT_NEAR(bare.force_N, Bed(none, kRadius_m).quasi_static_force_N(0.01), 1e-12);

  BedParameters inert;
  inert.drag_factor = 0.0;
  EXPECT_GT(Bed(inert, kRadius_m).reaction({0.01, 1.0, 0.01, 0.0}).added_mass_kg, 0.1);

  BedParameters steady = none;
  steady.steady_drag_coefficient = 1.0;
  const double area = std::numbers::pi * kRadius_m * kRadius_m;
  EXPECT_NEAR(Bed(steady, kRadius_m).reaction({0.05, 2.0, 0.05, 0.0}).force_N -
                  Bed(none, kRadius_m).quasi_static_force_N(0.05),
              1450.0 * area * 4.0, 1e-9);
}

TEST(Bed, PowerLawHasTheStiffnessOfItsCoefficientAtOneCentimetre) {
  BedParameters p;
  p.stiffness_per_area_N_per_m3 = 3e5;
  p.exponent = 1.3;
  const Bed bed(p, kRadius_m);
  const double area = std::numbers::pi * kRadius_m * kRadius_m;
  EXPECT_NEAR(bed.quasi_static_force_N(0.01), 3e5 * area * 0.01, 1e-9);
  EXPECT_NEAR(bed.quasi_static_force_N(0.02) / bed.quasi_static_force_N(0.01), std::pow(2.0, 1.3), 1e-9);
}

TEST(Bed, FluctuationHasTheStatedSpreadAndDependsOnDepthAlone) {
  double square = 0.0, product = 0.0;
  int n = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    BedFluctuation f{.relative = 0.02};
    Random random(seed, 0);
    for (auto& knot : f.knots) knot = random.normal();
    EXPECT_EQ(f.factor(0.0123), f.factor(0.0123));
    for (double z = 0.0005; z < 0.05; z += 0.0007) {
      square += std::pow(f.factor(z) - 1.0, 2);
      product += (f.factor(z) - 1.0) * (f.factor(z + 0.008) - 1.0);
      ++n;
    }
  }
  EXPECT_NEAR(std::sqrt(square / n), 0.02, 0.0005);
  EXPECT_NEAR(product / square, 0.0, 0.05);
  EXPECT_EQ(BedFluctuation{}.factor(0.03), 1.0);
}

}  // namespace
}  // namespace sandhopper
