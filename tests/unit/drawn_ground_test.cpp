#include "tools/experiment/drawn_ground.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "terrain/joint_config.hpp"
#include "terrain/profile_config.hpp"

namespace sandhopper {
namespace {

// If somebody changes the fit's prior, this test asks for the same change of the experiment's truth.
TEST(DrawnGround, PriorIsThatOfTheFit) {
  EXPECT_EQ(GroundPrior{}.added_mass_factor, JointConfig{}.added_mass_factor);
  EXPECT_EQ(GroundPrior{}.added_mass_factor_sd, JointConfig{}.added_mass_factor_sd);
  EXPECT_EQ(GroundPrior{}.steady_drag_sd, ProfileConfig{}.steady_drag_sd);
}

TEST(DrawnGround, HasTheSpreadOfThePrior) {
  constexpr int kGrounds = 4000;
  double drag = 0.0, drag_squared = 0.0, mass = 0.0;
  for (std::uint64_t seed = 1; seed <= kGrounds; ++seed) {
    const auto ground = on_drawn_ground({}, GroundDraw::prior, seed).terrain;
    EXPECT_GE(ground.added_mass_factor, 0.0);
    drag += ground.steady_drag_coefficient;
    drag_squared += ground.steady_drag_coefficient * ground.steady_drag_coefficient;
    mass += ground.added_mass_factor;
  }
  EXPECT_NEAR(drag / kGrounds, 0.0, 0.025);  // three standard errors
  EXPECT_NEAR(std::sqrt(drag_squared / kGrounds), GroundPrior{}.steady_drag_sd, 0.017);
  // Mean of N(1, 1.5) above zero: 1 + 1.5 phi(2/3) / Phi(2/3).
  EXPECT_NEAR(mass / kGrounds, 1.64, 0.05);
}

TEST(DrawnGround, IsTheSameForTheSameSeedOnly) {
  const auto factor = [](std::uint64_t seed) {
    return on_drawn_ground({}, GroundDraw::prior, seed).terrain.added_mass_factor;
  };
  EXPECT_EQ(factor(7), factor(7));
  EXPECT_NE(factor(7), factor(8));
}

TEST(DrawnGround, CentreIsTheWorldsOwn) {
  WorldConfig world;
  world.terrain.added_mass_factor = 0.7;
  world.terrain.steady_drag_coefficient = 0.2;
  const auto centre = on_drawn_ground(world, GroundDraw::centre, 1).terrain;
  EXPECT_EQ(centre.added_mass_factor, 0.7);
  EXPECT_EQ(centre.steady_drag_coefficient, 0.2);
  const auto none = on_drawn_ground(world, GroundDraw::without_inertia, 1).terrain;
  EXPECT_EQ(none.added_mass_factor, 0.0);
  EXPECT_EQ(none.steady_drag_coefficient, 0.0);
}

}  // namespace
}  // namespace sandhopper
