#include "tools/experiment/drawn_ground.hpp"

#include "tools/plant/random.hpp"

namespace sandhopper {
namespace {

constexpr std::uint64_t kStream = 1000;  // apart from the streams of a trial (trial_draw.cpp)

}  // namespace

WorldConfig on_drawn_ground(WorldConfig world, GroundDraw draw, std::uint64_t seed) {
  constexpr GroundPrior kPrior;
  auto& ground = world.terrain;
  switch (draw) {
    case GroundDraw::prior: {
      Random random(seed, kStream);
      ground.steady_drag_coefficient = kPrior.steady_drag_sd * random.normal();
      do {
        ground.added_mass_factor = kPrior.added_mass_factor + kPrior.added_mass_factor_sd * random.normal();
      } while (ground.added_mass_factor < 0.0);
      break;
    }
    case GroundDraw::without_inertia:
      ground.added_mass_factor = ground.steady_drag_coefficient = 0.0;
      break;
    case GroundDraw::centre:
      break;
  }
  return world;
}

}  // namespace sandhopper
