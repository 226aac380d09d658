#pragma once
#include <functional>
#include <span>

#include "terrain/strength_profile.hpp"

// The set-up of the next stride that is expected to tell most about the ground: the drop height and leg
// stiffness after which the widest part of the profile's band is narrowest, in newtons. A stride is predicted
// on the profile's mean by two masses and a leg spring: the foot penetrates, drags grains along and stands
// where it comes to rest. What it would measure is added to a copy of the solver, whose band hardly depends
// on the values measured. The ground below the present depth is a guess, and so is the depth that is reached:
// the expected width is the mean over a stride on the curve and on it plus and minus root 3 deviations of its
// band (Gauss-Hermite quadrature of three points). The next stride falls on fresh ground prepared alike.
namespace sandhopper {

struct HopModel {
  double body_mass_kg = 2.0;
  double foot_mass_kg = 0.68;  // with its share of the leg
  double foot_radius_m = 0.040;
  double compression_length_m = 0.30;
  double extension_length_m = 0.34;
  double extension_stiffness_N_per_m = 500.0;
  // The motors push no more than this at this length of the leg [m, N].
  std::function<double(double)> greatest_leg_force_N = [](double) { return 50.0; };
  double rail_friction_N = 4.0;
};

struct StrideSetup {
  double drop_height_m = 0.0;  // of the sole over the surface
  double leg_stiffness_N_per_m = 0.0;
};

// From a depth at which the surface's own error is small, to the height of the foot.
struct DepthRange {
  double from_m = 0.005;
  double to_m = 0.050;
};

struct NextStride {
  StrideSetup setup{};
  double reach_m = 0.0;            // depth that it is expected to reach
  DepthRange range{};              // the depths of interest, as far as any candidate is expected to reach
  double widest_now_N = 0.0;       // greatest width of the 95 % band of the force there
  double widest_expected_N = 0.0;  // after it
};

// Greatest width of the band of the force in this range.
double widest_band_N(const ProfileSolver& solver, const DepthRange& range) noexcept;

// The sums that a stride with this set-up would give on the profile's mean plus `deviations` of its band.
ProfileSums predicted_stride(const ProfileSolver& solver, const HopModel& robot, const StrideSetup& setup,
                             double deviations = 0.0);

// The best of `candidates`, which must not be empty and must be within the robot's limits.
NextStride next_stride(const ProfileSolver& solver, const HopModel& robot,
                       std::span<const StrideSetup> candidates, const DepthRange& interest = {});

}  // namespace sandhopper
