#pragma once
#include <functional>
#include <span>

#include "terrain/strength_profile.hpp"

// Set-up of the next stride that is expected to give most information about the ground: the drop height and
// leg stiffness that minimise the largest width [N] of the profile's band, without the part that no stride
// narrows (ProfileSolver::Band). A predicted stride fits the curve in every cell, so in a forecast that part
// would become smaller, although in a real stride it does not. A stride is predicted on the
// profile's mean by two masses and a leg spring: the foot penetrates, accelerates grains and stays where it
// comes to rest. Its predicted samples are added to a copy of the solver; the width of the band hardly
// depends on their values. The ground below the present depth, and so the depth reached, is uncertain.
// Therefore the expected width is the mean over strides on the mean curve and on the curve plus and minus
// root 3 deviations of its band (Gauss-Hermite quadrature of three points). A stride is measured when the leg
// has extended and the foot lifts off. With too little energy for it, on soft ground, the robot comes to rest
// and the stride gives nothing. The next stride is assumed to be on fresh ground prepared alike.
namespace sandhopper {

struct HopModel {
  double body_mass_kg = 2.0;
  double foot_mass_kg = 0.68;  // including its share of the leg
  double foot_radius_m = 0.040;
  double compression_length_m = 0.30;
  double extension_length_m = 0.34;
  double extension_stiffness_N_per_m = 500.0;
  // Largest push of the motors [N] at this length of the leg [m].
  std::function<double(double)> greatest_leg_force_N = [](double) { return 50.0; };
  double rail_friction_N = 4.0;
  double gravity_mps2 = 9.81;
};

struct StrideSetup {
  double drop_height_m = 0.0;  // height of the sole over the surface
  double leg_stiffness_N_per_m = 0.0;
};

// Depths from which on the error of the surface is small, down to the height of the foot.
struct DepthRange {
  double from_m = 0.005;
  double to_m = 0.050;
};

struct NextStride {
  StrideSetup setup{};
  double reach_m = 0.0;            // expected depth of the stride
  DepthRange range{};              // depths of interest, limited to the largest depth that a candidate is
                                   // expected to reach
  double widest_now_N = 0.0;       // present largest width of the narrowable 95 % band in `range`
  double widest_expected_N = 0.0;  // expected width after the stride
};

// Largest width of the band of the force in this range [N].
double widest_band_N(const ProfileSolver& solver, const DepthRange& range,
                     ProfileSolver::Band band = ProfileSolver::Band::whole) noexcept;

// Sums that a stride with this set-up would give on the profile's mean plus `deviations` of its band. Empty
// if the robot would not lift off.
ProfileSums predicted_stride(const ProfileSolver& solver, const HopModel& robot, const StrideSetup& setup,
                             double deviations = 0.0);

// The best of `candidates`. They must not be empty and must be within the robot's limits.
NextStride next_stride(const ProfileSolver& solver, const HopModel& robot,
                       std::span<const StrideSetup> candidates, const DepthRange& interest = {});

}  // namespace sandhopper
