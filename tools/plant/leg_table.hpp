#pragma once
#include <array>
#include <memory>
#include <vector>

#include "estimation/leg.hpp"

namespace sandhopper {

// A leg's dynamics as a function of its angle, from a table, because many simulations of one leg need them a
// few thousand times each. Cubic interpolation through the four nearest of equidistant angles. The error
// relative to estimation/leg.hpp is below 1e-7 of each quantity's largest magnitude. Angles outside the table
// are computed directly.
class LegTable {
 public:
  explicit LegTable(const Leg& leg);

  // dm12_kg_m_per_rad and dreduced_mass_kg_per_rad are 0, because the plant does not use them.
  LegDynamics dynamics(double angle_rad) const noexcept;
  LegKinematics kinematics(double angle_rad) const noexcept;

 private:
  static constexpr std::size_t kQuantities = 10;  // an even number is faster; the last one is unused
  using Quantities = std::array<double, kQuantities>;
  struct Interval {
    Quantities c0, c1, c2, c3;  // coefficients of the powers of the position in the interval, 0 to 1
  };

  // The first `count` quantities at an angle; false: the angle is outside of the table.
  bool interpolate(double angle_rad, std::size_t count, Quantities& q) const noexcept;

  Leg leg_;
  std::vector<Interval> intervals_;
};

// Table of this leg. Each thread keeps the last few tables.
std::shared_ptr<const LegTable> leg_table(const Leg& leg);

}  // namespace sandhopper
