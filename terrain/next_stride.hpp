#pragma once
#include <span>

#include "terrain/strength_profile.hpp"

// The set-up of the next stride that is expected to tell most about the ground: the drop height and leg stiffness
// after which the widest part of the profile's band is narrowest. A stride is predicted on the profile's mean by
// two masses and a leg spring (the foot penetrates, drags grains along and stands where it comes to rest); what
// it would measure is added to a copy of the solver, whose band does not depend on the values measured. The next
// stride falls on fresh ground prepared alike.
namespace sandhopper {

struct HopModel {
  double body_mass_kg = 2.0;
  double foot_mass_kg = 0.68;  // with its share of the leg
  double foot_radius_m = 0.040;
  double compression_length_m = 0.30;
  double extension_length_m = 0.34;
  double extension_stiffness_N_per_m = 500.0;
  double greatest_leg_force_N = 50.0;
};

struct StrideSetup {
  double drop_height_m = 0.0;  // of the sole over the surface
  double leg_stiffness_N_per_m = 0.0;
};

struct NextStride {
  StrideSetup setup{};
  double reach_m = 0.0;          // depth that it is expected to reach
  double widest_now = 0.0;       // greatest width of the 95 % band over its force, between the depths of interest
  double widest_expected = 0.0;  // after it
};

struct DepthRange {
  double from_m = 0.005;
  double to_m = 0.050;
};

// Greatest width of the band relative to the force in this range.
double widest_band(const ProfileSolver& solver, const DepthRange& range) noexcept;

// What a stride with this set-up would measure on the profile's mean.
ProfileSums predicted_stride(const ProfileSolver& solver, const HopModel& robot, const StrideSetup& setup);

// The best of `candidates`, which must not be empty and must be within the robot's limits. Set-ups that are
// expected to sink deeper than `range.to_m` plus a cell are left out where others remain.
NextStride next_stride(const ProfileSolver& solver, const HopModel& robot, std::span<const StrideSetup> candidates,
                       const DepthRange& range = {});

}  // namespace sandhopper
