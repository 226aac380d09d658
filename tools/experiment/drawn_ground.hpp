#pragma once
#include <array>
#include <cstdint>
#include <string_view>

#include "config/fields.hpp"
#include "tools/plant/world_config.hpp"

// Added mass and steady drag of the ground in an experiment (terrain/bed.hpp). The band of the strength
// profile is a statement about grounds that the prior allows for, so only grounds drawn from that prior show
// its coverage. On grounds that all have the prior's mean the band is too wide.
namespace sandhopper {

// The prior that the fit states for ground with inertia: [stiffness.joint] added_mass_factor and its
// deviation, and ProfileConfig::steady_drag_sd. The numbers stand here again on purpose: if the fit read its
// prior and the experiment its truth from one place, a narrower prior would narrow the truth, too, and no
// coverage would show it.
struct GroundPrior {
  double added_mass_factor = 1.0;
  double added_mass_factor_sd = 1.5;
  double steady_drag_sd = 0.5;
};

enum class GroundDraw : std::uint8_t {
  prior,            // drawn: added mass not below zero, steady drag of either sign
  without_inertia,  // neither added mass nor drag, which the prior holds as likely as the above
  centre            // as in world.toml
};
template <>
struct EnumNames<GroundDraw> {
  static constexpr std::array<std::string_view, 3> value{"prior", "without_inertia", "centre"};
};

// The same world on ground number `seed`. A negative steady drag is a drag that fades faster with depth than
// the cone grows. A negative added mass does not exist, so it is drawn again.
WorldConfig on_drawn_ground(WorldConfig world, GroundDraw draw, std::uint64_t seed);

}  // namespace sandhopper
