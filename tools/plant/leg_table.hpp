#pragma once
#include <array>
#include <memory>
#include <vector>

#include "estimation/leg.hpp"

namespace sandhopper {

// A leg's dynamics as a function of its angle, from a table: many simulations of one leg ask for them a few
// thousand times each. Cubic through the four nearest of equidistant angles; within 1e-7 of
// estimation/leg.hpp relative to each quantity's largest magnitude. Angles outside the table are computed as
// they are.
class LegTable {
 public:
  explicit LegTable(const Leg& leg);

  // All but dm12_kg_m_per_rad and dreduced_mass_kg_per_rad, which the plant has no use for: they are 0.
  LegDynamics dynamics(double angle_rad) const noexcept;

 private:
  static constexpr std::size_t kQuantities = 10;  // an even number is quicker; the last is not used
  using Quantities = std::array<double, kQuantities>;
  struct Interval {
    Quantities c0, c1, c2, c3;  // powers of the place in it, 0 to 1
  };
  Leg leg_;
  std::vector<Interval> intervals_;
};

// The table of this leg; the last few that a thread asked for are kept.
std::shared_ptr<const LegTable> leg_table(const Leg& leg);

}  // namespace sandhopper
