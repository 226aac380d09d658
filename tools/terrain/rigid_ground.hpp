#pragma once
#include <span>
#include <string>
#include <vector>

#include "tools/terrain/leg_hop.hpp"
#include "tools/terrain/trial_analysis.hpp"

// Lower bound of the stiffness of ground on which no depth can be measured, from the impact of a landing on a
// force plate. Between the last plate reading before contact and the peak of the impact, t_p later, the foot
// moves down by at most v t_p, because the ground only slows it. An undamped plate overshoots a sudden force
// by at most a factor of two, so the true force was at least half the peak F_p:
//   k >= F_p / (2 v t_p)
// v is the body's speed at the landing, from the plate's impulse over a cycle that ends as it began, plus the
// leg's extension rate if it extends. Force from drag or inertia of the ground counts as stiffness.
namespace sandhopper {

struct BlowBound {
  std::string trial{};
  double peak_N = 0.0;
  double rise_s = 0.0;
  double speed_mps = 0.0;
  double depth_m = 0.0;  // upper bound
  double stiffness_N_per_m = 0.0;
};

// Largest stiffness of a granular bed under the strength profile's prior (95 %). Stiffer ground is called
// rigid.
double stiffest_granular_N_per_m();

struct RigidGround {
  std::vector<BlowBound> landings{};
  double at_least_N_per_m = 0.0;  // lower 95 % limit of the mean of the bounds over hops; 0: no bound
  bool rigid() const { return at_least_N_per_m > stiffest_granular_N_per_m(); }
};

// `mass_kg` is the mass measured by the plate. Hops that start in contact give no bound.
RigidGround rigid_ground(std::span<const LegHop> hops, double tare_N, double mass_kg);

std::string rigid_answer(const RigidGround& ground);  // one sentence
nlohmann::ordered_json rigid_json(const RigidGround& ground);
StudyTable rigid_table(const RigidGround& ground);

}  // namespace sandhopper
