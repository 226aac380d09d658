#include "tools/conceal/bed/bed.hpp"

#include <gtest/gtest.h>

namespace sandhopper::conceal {
namespace {

// Two pushes lower the surface by 5 mm each. Above the lowered surface neither the grains nor speed-dependent
// forces may act.
TEST(ConcealedBed, NothingResistsAboveALoweredSurface) {
  Bed bed;
  bed.hidden.crater_m_per_push = 5e-3;
  bed.hidden.viscous_N_s_per_m = 5.0;
  bed.hidden.added_mass_kg = 0.1;
  BedState state;
  state.pushes = 2;
  const auto above = virgin(bed, state, 0.0, 0.0099, 0.5);
  EXPECT_EQ(above.steady_N, 0.0);
  EXPECT_EQ(above.moving_mass_kg, 0.0);
  const BedState fresh;
  const auto lowered = virgin(bed, state, 0.0, 0.02, 0.5), plain = virgin(bed, fresh, 0.0, 0.01, 0.5);
  EXPECT_NEAR(lowered.steady_N, plain.steady_N, 1e-9);
  EXPECT_NEAR(lowered.moving_mass_kg, plain.moving_mass_kg, 1e-12);
}

// The container's floor stays in place. With a surface that is 10 mm lower the bed must stiffen as much at
// the same distance above the floor.
TEST(ConcealedBed, TheFloorStaysUnderALoweredSurface) {
  Bed bed;
  bed.hidden.crater_m_per_push = 5e-3;
  BedState state, fresh;
  state.pushes = 2;
  state.bed_depth_m = fresh.bed_depth_m = 0.05;
  const auto stiffer_by = [&](const BedState& s) {
    Bed with = bed;
    with.hidden.floor_stiffening = 2.0;
    return static_N(with, s, 0.02) / static_N(bed, s, 0.02);
  };
  EXPECT_GT(stiffer_by(fresh), 1.1);
  EXPECT_NEAR(stiffer_by(state), stiffer_by(fresh), 1e-12);
}

}  // namespace
}  // namespace sandhopper::conceal
